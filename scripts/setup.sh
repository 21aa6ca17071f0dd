#!/usr/bin/env bash
# Installs what is missing (Debian 12; asks for sudo only if something is and you are not root) and builds the release
# preset into build/release. Safe to run again: what is there already is neither fetched nor built anew.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(
  cmake ninja-build g++
  libeigen3-dev libopencv-core-dev libopencv-imgproc-dev libopencv-video-dev libyaml-cpp-dev libcli11-dev
  libhdf5-dev libdeflate-dev libssl-dev libpng-dev libspdlog-dev nlohmann-json3-dev
  libgtest-dev     # the tests
  libceres-dev     # the tests: a second bundle adjustment
  libbenchmark-dev # the micro-benchmarks
  gnuplot-nox      # the plots, at run time
  make             # scripts/sweep.mk
)

is_installed() {
  [ "$(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

install_missing() {
  local missing=() package
  for package in "${packages[@]}"; do
    is_installed "$package" || missing+=("$package")
  done
  if [ ${#missing[@]} -eq 0 ]; then
    echo "setup: every package is installed"
    return
  fi
  local as_root=(env DEBIAN_FRONTEND=noninteractive)
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "setup: error: install these packages as root, then run this again: ${missing[*]}" >&2
      exit 1
    fi
    as_root=(sudo "${as_root[@]}")
  fi
  echo "setup: installing ${missing[*]} (a few minutes)"
  "${as_root[@]}" apt-get update -qq </dev/null
  "${as_root[@]}" apt-get install --yes -qq --no-install-recommends "${missing[@]}" </dev/null >/dev/null
}

if command -v apt-get >/dev/null && command -v dpkg-query >/dev/null; then
  install_missing
else
  echo "setup: no apt here; install what README.md lists under 'Dependencies' by other means" >&2
fi

echo "setup: building"
cmake --preset release
cmake --build --preset release --parallel "$(nproc)"
