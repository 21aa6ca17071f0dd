#!/usr/bin/env bash
# Installs what is missing (Debian 12; with sudo if you are not root) and builds the program into build/release.
# --tests also installs what tests and gates need, and builds the tests. Safe to call again: what is there stays.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(
  cmake ninja-build g++ make
  libeigen3-dev libopencv-core-dev libopencv-imgproc-dev libopencv-video-dev libyaml-cpp-dev libcli11-dev
  libhdf5-dev liblzf-dev libdeflate-dev libssl-dev libpng-dev libspdlog-dev libfmt-dev nlohmann-json3-dev
  gnuplot-nox # the plots, at run time
)
test_packages=(
  libgtest-dev libbenchmark-dev
  libceres-dev # a second bundle adjustment to compare with
  clang-format-14 clang-tidy-22 python3
)
build_tests=OFF
case "${1:-}" in
  "") ;;
  --tests)
    build_tests=ON
    packages+=("${test_packages[@]}")
    ;;
  *)
    echo "usage: scripts/setup.sh [--tests]" >&2
    exit 2
    ;;
esac

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
      echo "setup: error: install these packages as root, then call this again: ${missing[*]}" >&2
      exit 1
    fi
    as_root=(sudo "${as_root[@]}")
  fi
  echo "setup: installing ${missing[*]}"
  "${as_root[@]}" apt-get update -qq </dev/null
  "${as_root[@]}" apt-get install --yes -qq --no-install-recommends "${missing[@]}" </dev/null >/dev/null
}

if command -v apt-get >/dev/null && command -v dpkg-query >/dev/null; then
  install_missing
else
  echo "setup: apt is not available; install the packages of docs/install.md by other means" >&2
fi

echo "setup: building"
cmake --preset release -DEVO_BUILD_TESTS=$build_tests -DEVO_BENCHMARKS=$build_tests
cmake --build --preset release --parallel "$(nproc)"
