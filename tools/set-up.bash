# shellcheck shell=bash
# What the scripts need from the machine: a Rust toolchain (checked, never installed) and a few system packages
# (installed by apt where it is there, named for other systems). Sourced by tools/demo, test, check and .ci/run, which
# run from the root of the checkout.
#
# A need is a thing that can be looked for, not a package: what came by another way than apt counts.

# Where tools/drivers unpacks drivers, and tools/test looks for them.
# shellcheck disable=SC2034 # for the scripts that source this
drivers_folder=target/drivers

say() { printf '%s\n' "$*"; }
fail() {
    printf '\nerror: %s\n' "$1" >&2
    shift
    [ $# -eq 0 ] || printf '       %s\n' "$@" >&2
    exit 1
}

# phase SECONDS NAME...: adds a line to the table that .ci/run ends with: the file that QUINCUNX_PHASES names, where it is set.
phase() {
    [ -z "${QUINCUNX_PHASES:-}" ] || printf '%6d s  %s\n' "$1" "${*:2}" >>"$QUINCUNX_PHASES"
}

# The Rust toolchain, at least as new as Cargo.toml wants it. Ends the script where it is not.
need_rust() {
    # Just installed by rustup, and the shell not opened anew.
    if ! command -v cargo >/dev/null && [ -x "$HOME/.cargo/bin/cargo" ]; then
        PATH="$HOME/.cargo/bin:$PATH"
    fi
    local wanted found older
    wanted=$(sed -n 's/^rust-version *= *"\(.*\)"/\1/p' Cargo.toml)
    local -a ways=(
        "rustup, for one user, without root:  curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh"
        "or your distribution's packages of rustc and cargo, where they are $wanted or newer"
        "then run this again"
    )
    if ! command -v cargo >/dev/null || ! command -v rustc >/dev/null; then
        fail "no Rust toolchain: cargo and rustc, $wanted or newer, are needed" "${ways[@]}"
    fi
    found=$(rustc --version 2>/dev/null | sed -n 's/^rustc \([0-9][0-9.]*\).*/\1/p')
    [ -n "$found" ] || fail "rustc does not say its version: $(rustc --version 2>&1 | head -n 1)" "${ways[@]}"
    older=$(printf '%s\n%s\n' "$wanted" "$found" | sort -V | head -n 1)
    if [ "$older" != "$wanted" ]; then
        fail "rustc $found is too old: $wanted or newer is needed" "where rustup made it:  rustup update" "${ways[@]}"
    fi
    say "Rust: $found, $wanted or newer is needed"
}

# Files of a kind in the folders that the Vulkan loader reads, one a line: vulkan_files icd.d 'lvp_icd*.json'
vulkan_files() {
    find "${XDG_DATA_HOME:-$HOME/.local/share}/vulkan/$1" /etc/vulkan/"$1" /usr/local/share/vulkan/"$1" \
        /usr/share/vulkan/"$1" -name "$2" 2>/dev/null || true
}

# Is this need met?
has() {
    local cxx=${CXX:-c++}
    case $1 in
    loader)
        { PATH="$PATH:/usr/sbin:/sbin" ldconfig -p 2>/dev/null | grep -q 'libvulkan\.so\.1'; } ||
            compgen -G '/usr/lib*/libvulkan.so.1' >/dev/null || compgen -G '/usr/lib/*/libvulkan.so.1' >/dev/null
        ;;
    software-driver) [ -n "$(vulkan_files icd.d 'lvp_icd*.json')" ] ;;
    compiler) command -v "${cxx%% *}" >/dev/null && command -v cc >/dev/null ;;
    validation) [ -n "$(vulkan_files explicit_layer.d 'VkLayer_khronos_validation.json')" ] ;;
    spirv-tools) command -v spirv-val >/dev/null ;;
    shellcheck) command -v shellcheck >/dev/null ;;
    browser) command -v chromium >/dev/null || command -v chromium-browser >/dev/null || command -v google-chrome >/dev/null ;;
    *) fail "set-up.bash: no such need: $1" ;;
    esac
}

# The Debian package that meets a need.
debian_package() {
    case $1 in
    loader) echo libvulkan1 ;;
    software-driver) echo mesa-vulkan-drivers ;;
    compiler) echo g++ ;;
    validation) echo vulkan-validationlayers ;;
    browser) echo chromium ;;
    *) echo "$1" ;;
    esac
}

# What a need is for, in words.
purpose() {
    case $1 in
    loader) echo "the Vulkan loader" ;;
    software-driver) echo "Mesa's software Vulkan driver, lavapipe" ;;
    compiler) echo "a C++ compiler, for the shader compiler that the build makes" ;;
    validation) echo "Vulkan's validation layers" ;;
    spirv-tools) echo "spirv-val and its companions" ;;
    shellcheck) echo "the shell scripts' lint" ;;
    browser) echo "a browser, in which pages are tried" ;;
    esac
}

# For systems without apt: what each of them calls what is missing.
by_hand() {
    local need fedora=() arch=() suse=()
    for need in "$@"; do
        case $need in
        loader) fedora+=(vulkan-loader) arch+=(vulkan-icd-loader) suse+=(libvulkan1) ;;
        software-driver) fedora+=(mesa-vulkan-drivers) arch+=(vulkan-swrast) suse+=(libvulkan_lvp) ;;
        compiler) fedora+=(gcc-c++) arch+=(gcc) suse+=(gcc-c++) ;;
        validation) fedora+=(vulkan-validation-layers) arch+=(vulkan-validation-layers) suse+=(vulkan-validationlayers) ;;
        spirv-tools) fedora+=(spirv-tools) arch+=(spirv-tools) suse+=(spirv-tools) ;;
        shellcheck) fedora+=(ShellCheck) arch+=(shellcheck) suse+=(ShellCheck) ;;
        browser) fedora+=(chromium) arch+=(chromium) suse+=(chromium) ;;
        esac
    done
    printf '%s\n' \
        "Fedora:    sudo dnf install ${fedora[*]}" \
        "Arch:      sudo pacman -S --needed ${arch[*]}" \
        "openSUSE:  sudo zypper install ${suse[*]}" \
        "others:    the packages of these names, or what they stand for; then run this again"
}

# need_packages MAY_INSTALL NEED...: says what is there and what is missing, and installs the latter where MAY_INSTALL is
# yes. Ends the script, with the commands to type, where something stays missing.
need_packages() {
    local may_install=$1 need
    shift
    local -a missing=() packages=() lines=() root=()
    for need in "$@"; do
        has "$need" || { missing+=("$need") && packages+=("$(debian_package "$need")"); }
    done
    if [ ${#missing[@]} -eq 0 ]; then
        say "System packages: nothing to install ($* found)"
        return
    fi
    for need in "${missing[@]}"; do
        lines+=("$(debian_package "$need"): $(purpose "$need")")
    done
    if ! command -v apt-get >/dev/null; then
        mapfile -t -O ${#lines[@]} lines < <(by_hand "${missing[@]}")
        fail "missing, and there is no apt-get here to install it:" "${lines[@]}"
    fi
    local command="apt-get install --no-install-recommends ${packages[*]}"
    if [ "$may_install" != yes ]; then
        fail "missing, and --no-install was given:" "${lines[@]}" "as root:  $command"
    fi
    say "Will install by apt, because missing:"
    printf '  %s\n' "${lines[@]}"
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || fail "not root, and there is no sudo" "as root:  $command"
        root=(sudo)
        say "(sudo may ask for your password)"
    fi
    # Old lists name packages that are gone; a list that does not come is no failure while the packages do.
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq update || say "note: apt-get update failed; going on"
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -y install --no-install-recommends "${packages[@]}" ||
        fail "apt-get could not install ${packages[*]}" "as root:  $command"
    for need in "${missing[@]}"; do
        has "$need" || fail "$(debian_package "$need") is installed, but $(purpose "$need") is not found"
    done
}

# Lavapipe alone, where the user has not chosen a driver: the same pictures on every machine.
use_software_driver() {
    if [ -n "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ]; then
        say "Vulkan driver: ${VK_DRIVER_FILES:-$VK_ICD_FILENAMES}, as the environment says"
        return
    fi
    VK_DRIVER_FILES=$(vulkan_files icd.d 'lvp_icd*.json' | paste -sd :)
    # Loaders before 1.3.207 know only the second name.
    export VK_DRIVER_FILES VK_ICD_FILENAMES=$VK_DRIVER_FILES
    say "Vulkan driver: $VK_DRIVER_FILES (set VK_DRIVER_FILES for another)"
}

# Builds the layer of tools/pretend, for Linux; its folder is $QUINCUNX_PRETEND_LAYER then.
build_pretend_layer() {
    [ "$(uname -s)" = Linux ] || return 0
    say "Building: cargo build --locked --release --manifest-path tools/pretend/Cargo.toml"
    cargo build --quiet --locked --release --manifest-path tools/pretend/Cargo.toml --target-dir target/pretend
    cp tools/pretend/layer.json target/pretend/release/
    QUINCUNX_PRETEND_LAYER=$PWD/target/pretend/release
    export QUINCUNX_PRETEND_LAYER
}

# Builds the program with the profile of QUINCUNX_PROFILE (release or dev) and puts its path in $program.
build_program() {
    local profile=${QUINCUNX_PROFILE:-release} folder target
    case $profile in
    release) folder=release ;;
    dev) folder=debug ;;
    *) fail "QUINCUNX_PROFILE=$profile: release or dev" ;;
    esac
    say "Building: cargo build --locked --profile $profile"
    cargo build --locked --profile "$profile"
    target=$(cargo metadata --locked --no-deps --format-version 1 | sed 's/.*"target_directory":"\([^"]*\)".*/\1/')
    # shellcheck disable=SC2034 # for the script that sourced this
    program=$target/$folder/quincunx
}
