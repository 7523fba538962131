#!/usr/bin/env bash
# tests/gpu/run.sh [--build-only] [--prepared DIR] [--queries N]: on a machine with a GPU, nvcc and CMake and nothing
# else: builds the methods and their kernels, compares their answers with the processor's on all prepared queries and on
# N (10^7) made from them, and measures them beside the limits of the device. Prints one table; the same as JSON is in
# DIR/gpu.json. What tests/gpu/prepare.sh wrote is in DIR (build/gpu). Exit status 0: all answers are equal; 1: not; 2:
# no GPU.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
prepared=$root/build/gpu
queries=10000000
run=true
while [[ $# -gt 0 ]]; do
  case $1 in
    --build-only) run=false ;;
    --prepared) prepared=$(cd "$2" && pwd); shift ;;
    --queries) queries=$2; shift ;;
    *) sed -n '2,6s/^# //p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
  esac
  shift
done
for folder in /usr/local/cuda/bin /opt/cuda/bin; do
  if ! command -v nvcc >/dev/null && [[ -x $folder/nvcc ]]; then PATH=$PATH:$folder; fi
done

# Code for the GPUs that are here; where none is, for the oldest one, which says whether it builds.
architectures=75-virtual
if nvidia-smi -L >/dev/null 2>&1; then
  architectures=$(nvidia-smi --query-gpu=compute_cap --format=csv,noheader | tr -d . | sort -u | sed 's/$/-real/' | paste -sd ';')
fi
start=$SECONDS
cmake -S "$root/tests/gpu/bare" -B "$prepared/build" -DPREPARED="$prepared" -DCMAKE_CUDA_ARCHITECTURES="$architectures" \
  -DCMAKE_BUILD_TYPE=Release >"$prepared/build.log" 2>&1 &&
  cmake --build "$prepared/build" --parallel "${JOBS:-$(nproc)}" >>"$prepared/build.log" 2>&1 || {
  tail -40 "$prepared/build.log"
  exit 1
}
echo "built for $architectures in $((SECONDS - start)) s"
$run || exit 0

status=0
"$prepared/build/gpu_check" "$prepared" --queries "$queries" --json "$prepared/gpu.json" || status=$?
[[ $status -ne 2 ]] || exit 2
if command -v compute-sanitizer >/dev/null; then
  for tool in memcheck racecheck; do
    found=0
    timeout 90 compute-sanitizer --tool "$tool" --error-exitcode 3 "$prepared/build/gpu_check" "$prepared" --small \
      >"$prepared/$tool.log" 2>&1 || found=$?
    # What it finds it says at once, in lines that begin like its first one, "========= COMPUTE-SANITIZER".
    if [[ $found == 124 ]] && grep -q '^========= [^C]' "$prepared/$tool.log"; then found=3; fi
    case $found in
      0) echo "compute-sanitizer $tool: clean" ;;
      124) echo "compute-sanitizer $tool: not finished in 90 s, clean so far" ;;
      *)
        echo "compute-sanitizer $tool: exit status $found (see $tool.log)"
        tail -5 "$prepared/$tool.log"
        status=1
        ;;
    esac
  done
else
  echo "compute-sanitizer: not there"
fi
echo "all in $((SECONDS - start)) s"
exit $status
