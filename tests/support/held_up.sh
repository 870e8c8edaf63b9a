# was_held_up FILE: what a session said in FILE is that the machine held it up: for a tenth of a second none of its ticks came,
# and the governor stopped the force, as it should. A script then runs the session again, twice at most: a program that stalls
# by itself does so each time.
was_held_up() { grep -q 'the governor stopped the force: loop-stalled' "$1" && echo 'a session is repeated: the machine held it up'; }
