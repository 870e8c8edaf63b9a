# Sourced by samples/demo.sh and tests/run.sh, after cd to the checkout: installs what is missing, configures, builds.
# POSIX sh; needs nothing but a base system.
#
#   prepare_options "$@"     reads --yes --no-install --dry-run
#   prepare_packages LIST    makes sure that the packages are there
#   prepare_build DIR ARGS   configures (Release) and builds the folder DIR

# What the library and the programs are made of, what the tests add, what makes Debian packages, and what the gate of a release
# adds; third_party_notes.md has a row for each.
packages_build='g++ cmake make libembree-dev libtbb-dev libeigen3-dev libglm-dev libcli11-dev nlohmann-json3-dev libstb-dev zlib1g-dev fonts-dejavu-core libvulkan-dev libusb-1.0-0-dev libhidapi-dev libglfw3-dev libimgui-dev pkg-config glslang-tools mesa-vulkan-drivers'
packages_tests='python3 python3-numpy libgtest-dev libbenchmark-dev libnanoflann-dev libsuitesparse-dev libopenblas0-serial spirv-tools vulkan-validationlayers xvfb xauth xdotool libx11-dev dpkg-dev file'
packages_package='dpkg-dev file'
# Of a release's gate: memory, another compiler, another Vulkan driver, the reference, samples/unity, the manual.
packages_gate='valgrind clang libclang-rt-14-dev chromium-common doxygen mono-mcs groff-base'

assume_yes= no_install= dry_run=
prepare_options() {
    for option; do
        case $option in
        --yes) assume_yes=1 ;;
        --no-install) no_install=1 ;;
        --dry-run) dry_run=1 ;;
        esac
    done
}

say() { printf '%s\n' "$*"; }

missing_of() {
    for package; do
        dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed' || printf '%s ' "$package"
    done
}

prepare_packages() {
    if ! command -v dpkg-query >/dev/null 2>&1; then
        say "This is not a Debian or Ubuntu system. Palpate needs what these packages hold: $*"
        return 0
    fi
    missing=$(missing_of "$@")
    missing=${missing% }
    [ -n "$missing" ] || return 0

    # shellcheck disable=SC2086  # a list of words on purpose
    set -- $missing
    line="apt-get install -y --no-install-recommends $*"
    say "Missing packages: $*"
    if [ -n "$dry_run" ]; then say "would run: $line"; return 0; fi
    if [ -n "$no_install" ]; then say "--no-install was given; an administrator can run: $line"; exit 3; fi

    as_root=
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null 2>&1; then
            say "Not root, and there is no sudo. Ask an administrator to run: $line"
            exit 3
        elif [ -n "$assume_yes" ] && sudo -n true 2>/dev/null; then
            as_root='sudo -n'
        elif [ -t 0 ] && [ -z "$assume_yes" ]; then
            printf 'Install them now? It runs: sudo %s  [y/N] ' "$line"
            read -r answer
            case $answer in y | Y | yes) as_root=sudo ;; *) say "Nothing was installed."; exit 3 ;; esac
        else
            say "Not root, and nobody to ask. Run: sudo $line"
            exit 3
        fi
    fi
    # The lists may be empty or old: fetch them only if they are needed. sudo drops the environment, so env goes inside.
    ls /var/lib/apt/lists/*_Packages* >/dev/null 2>&1 || $as_root apt-get update
    install="$as_root env DEBIAN_FRONTEND=noninteractive $line"
    if ! $install; then
        say "Fetching the package lists and trying once more."
        $as_root apt-get update && $install || { say "The packages could not be installed: $*"; exit 3; }
    fi
}

jobs() {
    cores=$(nproc 2>/dev/null || echo 1)
    # A C++ compiler takes up to 1.5 GB here.
    fits=$(awk '/^MemAvailable/ { print int($2 / 1500000) }' /proc/meminfo 2>/dev/null)
    [ "${fits:-1}" -ge 1 ] || fits=1
    if [ "$cores" -lt "$fits" ]; then echo "$cores"; else echo "$fits"; fi
}

# An existing folder keeps the options in its cache, except those that are given here.
prepare_build() {
    build=$1
    shift
    if [ -n "$dry_run" ]; then say "would build in $build"; return 0; fi
    if ! mkdir -p "$build" || [ ! -w "$build" ]; then
        say "The folder $build cannot be written; remove it, or name another one with PALPATE_BUILD=FOLDER."
        exit 2
    fi
    # Make, not Ninja: Ninja 1.11 loses every dependency in a path with an apostrophe and builds all anew each time.
    cmake -S . -B "$build" -DCMAKE_BUILD_TYPE=Release "$@" >"$build/configure.log" 2>&1 || {
        cat "$build/configure.log"
        exit 1
    }
    cmake --build "$build" --parallel "$(jobs)" || exit 1
}
