#!/usr/bin/env bash
# What conda-build runs. Only the program is packed: its libraries are static.
set -euo pipefail
cmake -S . -B build-conda -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$PREFIX" -DCMAKE_PREFIX_PATH="$PREFIX" \
    -DFELDSPAR_TESTS=OFF -DFELDSPAR_BENCHMARKS=OFF
cmake --build build-conda --parallel "${CPU_COUNT:-2}"
cmake --install build-conda --component program
