#!/usr/bin/env bash
# Sets up and runs all tests. Ends with ctest's summary and its exit code; options go to ctest (test.sh -R io).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scripts/setup.sh
exec ctest --preset release "$@"
