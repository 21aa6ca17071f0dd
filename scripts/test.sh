#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests. Options go to ctest: scripts/test.sh -R io
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scripts/setup.sh --tests
exec ctest --preset release "$@"
