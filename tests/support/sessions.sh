# What scripts that run sessions share; each reads it.

# was_held_up FILE: what a session said in FILE is that the machine held it up: for a tenth of a second none of its ticks came,
# and the governor stopped the force, as it should. A script then runs the session again, twice at most: a program that stalls
# by itself does so each time.
was_held_up() { grep -q 'the governor stopped the force: loop-stalled' "$1" && echo 'a session is repeated: the machine held it up'; }

# was_pushed_and_let_go FILE: what samples/bridge_peer.py printed: a force, and in the end a command of none, which is not the
# device's own watchdog.
was_pushed_and_let_go() { grep -q 'rendered at most [0-9.]*[1-9][0-9.]* N; the last command asked for 0.00 N' "$1"; }
