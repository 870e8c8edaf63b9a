#!/bin/sh
# Checks that includes point downward and that each outside library stays behind its wall. Argument: the checkout.
set -u
cd "$1" || exit 1

# The layers from the bottom up. A file may include its own folder and those before it; subfolders count as their folder.
layers='core compute cloud contact chart plate body force pipeline session perception capi tools/plot tools/render tools/gui tools/bench tools/paper tools/study tools/fit tools/cli'
# layer_of prints the layer of a path below engine/, level_of its place in the list.
layer_of() {
    case $1 in
    tools/*/*) rest=${1#tools/}; echo "tools/${rest%%/*}" ;;
    *) echo "${1%%/*}" ;;
    esac
}
level_of() {
    n=0
    for layer in $layers; do
        [ "$layer" = "$1" ] && { echo $n; return; }
        n=$((n + 1))
    done
    echo none
}

bad=0
complain() { echo "$*"; bad=1; }

# All files at all depths are checked: the folders that hold sources are found, not listed.
files=$(find engine -name '*.h' -o -name '*.cpp' | sort)
session=$(level_of session)
for folder in $(for file in $files; do dirname "$file"; done | sort -u); do
    layer=$(layer_of "${folder#engine/}/")
    level=$(level_of "$layer")
    [ "$level" = none ] && { complain "$folder is in no known layer: add it to tests/layering.sh"; continue; }
    for file in "$folder"/*.h "$folder"/*.cpp; do
        [ -f "$file" ] || continue
        for name in $(sed -n 's|^ *# *include *"\([^"]*\)".*|\1|p' "$file"); do
            case $name in
            engine/*)
                target=$(layer_of "${name#engine/}")
                other=$(level_of "$target")
                [ "$other" != none ] && [ "$other" -le "$level" ] || complain "$file includes engine/$target, which is above it"
                ;;
            compute_shaders/shared/* | compute_shaders/*.spv.h | stb/*) ;;
            device/*) [ "$level" -ge "$session" ] || complain "$file includes \"$name\": only sessions and tools know devices" ;;
            *) complain "$file includes \"$name\": write project includes from the root" ;;
            esac
        done
    done
done

# What lies in X/detail is for X and the folders below it.
strangers=$(grep -rnE '^ *# *include *"[^"]*/detail/' engine device samples --include='*.h' --include='*.cpp' |
    awk -F'[:"]' '{ owner = $4; sub("/detail/.*", "/", owner); if (index($1, owner) != 1) print $1 " includes " $4 }')
[ -z "$strangers" ] || complain "a folder detail/ is used from outside its folder: $strangers"

# A header outside of detail/ may be installed, and one inside is not.
hidden=$(grep -rnE '^ *# *include *"[^"]*/detail/' engine device --include='*.h' | grep -v '^[^:]*/detail/')
[ -z "$hidden" ] || complain "a header that others include needs one of a folder detail/, which is not installed: $hidden"

# The reference solver shares no code with the solver that it judges.
shared=$(grep -rnE '^ *# *include *"(engine/plate/(multigrid|host)|engine/compute|compute_shaders)/' engine/plate/reference)
[ -z "$shared" ] || complain "the reference solver shares code with the solver that it judges: $shared"

# A device knows forces and positions, and nothing of objects.
others=$(grep -rnE '^ *# *include *"' device --include="*.h" --include="*.cpp" | grep -vE '"(device|engine/core)/')
[ -z "$others" ] || complain "device/ includes more than engine/core: $others"

# claim CLAIM PATTERN FILES: only FILES may have code that matches PATTERN; what stands in comments does not count
claim() {
    found=$(grep -rnE "$2" engine device --include='*.h' --include='*.cpp' | grep -vE '^[^:]*:[0-9]*: *//' |
        grep -vE "^(engine|device)/($3):")
    [ -z "$found" ] || complain "$1: $found"
}
claim 'a shell is run, or a program that is looked for in PATH' \
    '\b(system|popen|wordexp|execlp|execvpe?|posix_spawnp)\(' none
claim 'another program is started' '\b(execve?|execle?|posix_spawn|v?fork)\(' \
    'tools/bench/one_thread\.cpp|detail/guardian\.cpp'
claim 'a port of the network is opened, beyond those of markers and of the bridge' \
    '(^|[^A-Za-z_>.])::(bind|listen|accept4?)\(|[^A-Za-z_>.:](bind|listen|accept4?)\(([a-z]*_)?(fd|sock|socket|handle)' \
    'session/udp_address\.cpp|hid/bridge_lines\.cpp'
claim 'the clock on the wall is read, which jumps; it is for dates alone' 'system_clock|CLOCK_REALTIME|\btime\(nullptr\)' \
    'session/(session_clocks\.h|recording\.cpp|udp_outlet\.h)|tools/cli/calibrate\.cpp'
claim 'a file or a folder is written past core/file.h, which refuses links of strangers' \
    'ofstream|\bfopen\(|\bfreopen\(|O_CREAT|O_APPEND|O_TRUNC|mkstemp|\bcreat\(|create_director|\bmkdir(at)?\(' \
    'core/file\.cpp'
claim 'a file is opened for writing past core/file.h, and is no device or stream' 'O_WRONLY|O_RDWR' \
    'core/file\.cpp|hid/(hidapi_system|bridge_lines)\.cpp|falcon/detail/usb_node\.cpp|tools/cli/main\.cpp'

# wall LIBRARY PATTERN FILES: only FILES may hold includes that match PATTERN
wall() {
    found=$(grep -rlE "^ *# *include *[<\"]$2" engine device --include='*.h' --include='*.cpp' | grep -vE "^(engine|device)/($3)$")
    [ -z "$found" ] || complain "$1 is included outside its wall: $found"
}
wall Embree 'embree[34]/' 'cloud/(detail/embree\.h|neighbour_index\.cpp)'
wall Eigen 'Eigen/' '(body|body/detail|cloud/detail|contact/detail|chart|chart/detail|plate/reference|plate/multigrid|plate/multigrid/detail)/[a-z_]*\.cpp|plate/(thrust|curved_bending)\.cpp|pipeline/detail/body_on_window\.cpp|tools/(bench/eigen_solver|fit/least_squares)\.cpp'
wall nlohmann-json 'nlohmann/' '[a-z/]*/[a-z_]*\.cpp|tools/cli/[a-z_]*\.h'
wall CLI11 'CLI/' 'tools/cli/[a-z_]*\.(h|cpp)'
wall Vulkan 'vulkan/' '(compute|compute/detail|tools/render)/vulkan_[a-z_]*\.(h|cpp)|tools/gui/glfw_window\.cpp'
wall GLFW 'GLFW/' 'tools/gui/glfw_[a-z]*\.cpp'
wall ImGui '(imgui|backends/imgui)' 'tools/(render/vulkan_panels|gui/(panel[a-z_]*|glfw_[a-z]*))\.cpp'
wall CHOLMOD '(suitesparse/)?cholmod' 'tools/bench/cholmod_solver\.cpp'
wall nanoflann 'nanoflann' 'tools/bench/nanoflann_search\.cpp'
wall stb 'stb' 'tools/(plot/png|render/text)\.cpp'
wall libusb 'libusb' 'falcon/detail/libusb_[a-z]*\.cpp'
wall hidapi 'hidapi' 'hid/hidapi_[a-z]*\.cpp'

# Public headers name no type of a wrapped library.
grep -rnE 'RTC[A-Z]|Eigen::|nlohmann::|stbi_|Vk[A-Z]|VK_|libusb_[a-z]|hid_[a-z]*\(' engine device --include='*.h' |
    grep -vE '^engine/(cloud/detail/embree\.h|(compute|tools/render)/vulkan_[a-z]*\.h|tools/cli/)' | grep -vE ':[0-9]+: *//' &&
    complain 'a header names a type of a wrapped library'

[ $bad -eq 0 ] && echo 'every include points downward'
exit $bad
