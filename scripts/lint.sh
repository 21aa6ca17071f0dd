#!/usr/bin/env bash
# Runs clang-tidy (rules: .clang-tidy) over the sources of the program, or over the files given.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[ -f build/release/compile_commands.json ] || scripts/setup.sh --tests
files=("$@")
[ $# -gt 0 ] || mapfile -t files < <(git ls-files 'src/*.cpp')
printf '%s\0' "${files[@]}" | xargs -0 -n 4 -P "$(nproc)" clang-tidy-22 -p build/release --quiet --extra-arg=-w
echo "lint: ${#files[@]} files are clean"
