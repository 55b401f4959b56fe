# What ./run and ./test share: install what is missing, configure, build. Sourced by bash with `root` set to the
# checkout. Everything said here goes to stderr, so that `./run settings --json` is clean on stdout. Apart from apt,
# nothing is written outside the checkout.

say() { printf '==> %s\n' "$*" >&2; }
die() { printf '%s: %s\n' "${0##*/}" "$*" >&2; exit 1; }

# The packages of .ci/packages.txt that dpkg does not list as installed, on one line.
missing_packages() {
  local package status
  sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$root/.ci/packages.txt" | while read -r package; do
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) || status=absent
    [[ $status == *installed && $status != *not-installed ]] || printf '%s ' "$package"
  done
}

install_packages() {
  command -v dpkg-query >/dev/null && command -v apt-get >/dev/null ||
    die "this is not Debian: install the counterparts of .ci/packages.txt yourself, then use --no-install"
  local missing as_root=()
  read -ra missing <<<"$(missing_packages)"
  ((${#missing[@]})) || return 0
  if ((EUID != 0)); then
    command -v sudo >/dev/null ||
      die "not root, and there is no sudo. As root: apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  local install=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends -q)
  say "Installing ${#missing[@]} Debian packages: ${missing[*]}"
  # Package lists that are absent or outdated show as packages that apt cannot find or fetch.
  if ! apt-get install -s --no-install-recommends "${missing[@]}" >/dev/null 2>&1 || ! "${install[@]}" "${missing[@]}" >&2
  then
    say "Refreshing apt's package lists"
    "${as_root[@]}" apt-get update -q >&2
    "${install[@]}" "${missing[@]}" >&2 || die "apt could not install: ${missing[*]}"
  fi
}

# configure PRESET FOLDER: once; afterwards Ninja runs CMake itself where a CMake file changed.
configure() {
  local preset=$1 folder=$2 options=()
  [[ -f $root/$folder/build.ninja ]] && return 0
  command -v cmake >/dev/null && command -v ninja >/dev/null ||
    die "cmake and ninja are needed (leave --no-install out, or install .ci/packages.txt)"
  command -v ccache >/dev/null && options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  [[ -n ${IRAD_UNITY_BATCH:-} ]] && options+=("-DIRAD_UNITY_BATCH=$IRAD_UNITY_BATCH")
  say "Configuring: cmake --preset $preset ${options[*]}"
  (cd "$root" && cmake --preset "$preset" "${options[@]}") >&2
}

# build FOLDER [TARGET…]
build() {
  local folder=$1
  shift
  (($#)) || set -- all
  say "Building $folder ($*) on $(nproc) cores"
  cmake --build "$root/$folder" --target "$@" --parallel "$(nproc)" >&2
}

# Caches stay in the checkout; a folder that the user has chosen is respected. ccache is to take precompiled headers, and
# to learn from the compiler what a source includes, not to read all of that first by itself.
export CCACHE_DIR=${CCACHE_DIR:-$root/.cache/ccache} CCACHE_BASEDIR=${CCACHE_BASEDIR:-$root} CCACHE_NOHASHDIR=1
export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros} CCACHE_DEPEND=1
export MESA_SHADER_CACHE_DIR=${MESA_SHADER_CACHE_DIR:-$root/.cache/mesa}
mkdir -p "$MESA_SHADER_CACHE_DIR"

if [[ ${1:-} == --no-install ]]; then
  shift
else
  install_packages
fi
