# Installs the Debian packages that are missing; says which before it does. Sourced by ./run and ./test.

build_packages="build-essential cmake ninja-build ccache mold pkg-config
  qt6-base-dev libqt6opengl6-dev libeigen3-dev nlohmann-json3-dev libfmt-dev libcli11-dev libzstd-dev libzip-dev
  libxxhash-dev nettle-dev libassimp-dev zlib1g-dev libpugixml-dev libhwy-dev libplplot-dev plplot-driver-cairo libpng-dev libepoxy-dev libgl-dev libegl-dev libgl1-mesa-dri libegl1
  libegl-mesa0 fonts-dejavu-core"
test_packages="xvfb xauth python3 clang-format-14 admesh lib3mf1 abigail-tools"

need_packages() {
  missing=""
  for package in "$@"; do
    status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
    [ "$status" = "install ok installed" ] || missing="$missing $package"
  done
  [ -n "$missing" ] || return 0
  echo "Installing Debian packages:$missing"
  as_root=""
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "Please install them as root: apt-get install$missing" >&2; return 1; }
    as_root=sudo
  fi
  $as_root apt-get update -qq
  # shellcheck disable=SC2086 # a list of names
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
}

# Configures once and builds what changed.
build() {
  [ -f build/release/build.ninja ] || { echo "Configuring build/release"; cmake --preset release >/dev/null; }
  echo "Building build/release ($(nproc) cores)"
  cmake --build build/release "$@"
}
