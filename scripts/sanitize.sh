#!/usr/bin/env bash
# Builds with sanitizers and runs the tests that they are for.
#   scripts/sanitize.sh address   memory errors and undefined behaviour: core, events, geometry, io, bad inputs of app
#   scripts/sanitize.sh thread    data races: the thread pool, the tracker, the odometry's two threads
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case "${1:-}" in
  address)
    preset=asan-ubsan
    # The others have no bad input of their own, and take long to build.
    modules='core;events;geometry;io;app'
    targets=(core_test events_test geometry_test io_test app_test)
    tests='^(core|events|geometry|io)\.|^app\.BadInput'
    ;;
  thread)
    preset=tsan
    modules='core;events;geometry;tracking;odometry'
    targets=(core_test tracking_test odometry_test)
    tests='^core\.ThreadPool|^tracking\..*Threads|^odometry\..*Thread'
    ;;
  *)
    sed -n '2,4p' "$0" >&2
    exit 2
    ;;
esac
cmake --preset "$preset" -DEVO_SANITIZE_MODULES="$modules"
cmake --build --preset "$preset" --parallel "$(nproc)" --target "${targets[@]}"
ctest --preset "$preset" -R "$tests"
