#!/usr/bin/env bash
# Formats the C++ sources with clang-format 14; with --check, lists those that differ and fails instead.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

options=(-i)
case "${1:-}" in
  "") ;;
  --check) options=(--dry-run --Werror) ;;
  *)
    echo "usage: scripts/format.sh [--check]" >&2
    exit 2
    ;;
esac

# Another version breaks other lines.
for formatter in clang-format-14 clang-format; do
  if command -v "$formatter" >/dev/null && "$formatter" --version | grep -q 'version 14\.'; then
    git ls-files -z '*.cpp' '*.hpp' | xargs -0 "$formatter" "${options[@]}"
    exit
  fi
done
echo "format: error: clang-format 14 is not installed; apt-get install clang-format-14" >&2
exit 1
