#!/bin/sh
# Includes point downward, and each outside library stays behind its wall. Argument: the checkout.
set -u
cd "$1" || exit 1

# From the bottom up; a file may include its own layer and those before it.
layers='core gpu cloud contact chart force plate pipeline session picture viewer window bench report study program'
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

for folder in engine/*/; do
    layer=$(basename "$folder")
    level=$(level_of "$layer")
    [ "$level" = none ] && { complain "$folder is not a known layer: add it to tests/layering.sh"; continue; }
    for file in "$folder"*.h "$folder"*.cpp; do
        [ -f "$file" ] || continue
        for target in $(sed -n 's|^ *# *include *"engine/\([a-z_]*\)/.*|\1|p' "$file"); do
            other=$(level_of "$target")
            [ "$other" != none ] && [ "$other" -le "$level" ] || complain "$file includes engine/$target, which is above it"
        done
        sed -n 's|^ *# *include *"\([^"]*\)".*|\1|p' "$file" | while read -r name; do
            case $name in
            engine/* | compute_shaders/shared/* | compute_shaders/*.spv.h | stb/*) ;;
            device/*) [ "$level" -ge "$(level_of session)" ] || echo "$file includes \"$name\": only sessions and programs know devices" ;;
            *) echo "$file includes \"$name\": write project includes from the root" ;;
            esac
        done | grep . && bad=1
    done
done

# A device knows forces and positions, nothing of objects.
others=$(grep -rnE '^ *# *include *"' device --include="*.h" --include="*.cpp" | grep -vE '"(device|engine/core)/')
[ -z "$others" ] || complain "device/ includes more than engine/core: $others"

# library: pattern of its includes: folders that may hold them
wall() {
    found=$(grep -rlE "^ *# *include *[<\"]$2" engine device --include='*.h' --include='*.cpp' | grep -vE "^(engine|device)/($3)$")
    [ -z "$found" ] || complain "$1 is included outside its wall: $found"
}
wall Embree 'embree[34]/' 'cloud/(embree\.h|neighbour_index\.cpp)'
wall Eigen 'Eigen/' '(chart|plate)/[a-z_]*\.cpp|bench/eigen_solver\.cpp'
wall nlohmann-json 'nlohmann/' '[a-z]*/[a-z_]*\.cpp|program/[a-z_]*\.h'
wall CLI11 'CLI/' 'program/[a-z_]*\.(h|cpp)'
wall Vulkan 'vulkan/' '(gpu|viewer)/vulkan_[a-z]*\.(h|cpp)|window/glfw_window\.cpp'
wall GLFW 'GLFW/' 'window/glfw_[a-z]*\.cpp'
wall ImGui '(imgui|backends/imgui)' '(viewer/vulkan_panels|window/(panel[a-z_]*|glfw_[a-z]*))\.cpp'
wall CHOLMOD '(suitesparse/)?cholmod' 'bench/cholmod_solver\.cpp'
wall nanoflann 'nanoflann' 'bench/nanoflann_search\.cpp'
wall stb 'stb' '(picture/png|viewer/text)\.cpp'
wall libusb 'libusb' 'falcon/libusb_[a-z]*\.cpp'
wall hidapi 'hidapi' 'hid/hidapi_[a-z]*\.cpp'

# Public headers name no type of a wrapped library.
grep -rnE 'RTC[A-Z]|Eigen::|nlohmann::|stbi_|Vk[A-Z]|VK_|libusb_[a-z]|hid_[a-z]*\(' engine device --include='*.h' | grep -vE '^engine/(cloud/embree\.h|(gpu|viewer)/vulkan_[a-z]*\.h|program/)' | grep -vE ':[0-9]+: *//' && complain 'a header names a type of a wrapped library'

[ $bad -eq 0 ] && echo 'every include points downward'
exit $bad
