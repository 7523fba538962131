#!/usr/bin/env bash
# tests/gpu/prepare.sh [DIR]: writes what tests/gpu/run.sh needs and a bare machine cannot make into DIR (build/gpu):
# the generated headers and queries as bare numbers, less than 50 MiB. On the machine that builds Tightrope.
#
# BUILD (build/release): a configured build folder. TIGHTROPE_SAMPLE_QUERIES: where the public benchmark's queries are,
# if they are.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
directory=${1:-$root/build/gpu}
build=${BUILD:-$root/build/release}

cmake --build "$build" --target tightrope_ccd tightrope-ccd raw_queries >/dev/null
rm -rf "$directory/include" "$directory/queries"
mkdir -p "$directory/include" "$directory/queries" "$directory/scenes"
cp "$build"/ccd/tightrope_ccd_predicates_predicates/*.h "$build"/ccd/tightrope_ccd_exact_predicates_predicates/*.h \
  "$directory/include"
rm -f "$directory"/include/*.simd.h "$directory"/include/*.cuda.h

generate() { # SCENE QUERIES
  "$build/bin/tightrope-ccd" generate "$1" --queries "$2" -o "$directory/scenes/$1.h5" >/dev/null
  "$build/bin/raw_queries" "$directory/scenes/$1.h5" -o "$directory/queries/$1"
}
generate cloth-fold 50000
generate degenerate-families 15000
for scene in grazing tangent near-coplanar needles tiny huge; do generate "$scene" 3000; done
rm -r "$directory/scenes"
"$build/bin/raw_queries" "$root/tests/data/hard" -o "$directory/queries/hard"
samples=${TIGHTROPE_SAMPLE_QUERIES:-$root/../shared/data/sample-queries}
if [[ -d $samples ]]; then
  "$build/bin/raw_queries" "$samples" -o "$directory/queries/samples"
fi
du -sh "$directory" | sed 's/\t/ in /'
