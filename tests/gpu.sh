#!/usr/bin/env bash
# Runs the GPU tests on a machine that has a GPU and a driver but no Rust.
#
#   tests/gpu.sh          on the machine that builds: makes the folder bundle/
#   bundle/run.sh [OUT]   on the machine with the GPU, from a copy of that folder: runs all of it, writes to OUT
#
# Both machines are Linux of the same architecture, and the second one's glibc is no older. With NVCC=.../nvcc the test of maths
# measures CUDA C++'s functions too.
set -euo pipefail
cd "$(dirname "$0")/.."

rm -rf bundle
mkdir -p bundle/tests bundle/data
cargo test --release --package optix-tests --package optix-host --lib --tests --no-run --message-format=json |
    grep -o '"executable":"[^"]*"' | cut -d'"' -f4 | while read -r executable; do
    name=$(basename "$executable")
    case $name in ui-* | macros-*) continue ;; esac # compile-time tests: they need Rust, and no GPU
    strip -o "bundle/tests/${name%-*}" "$executable"
done
tests/cust/stub.sh "${CARGO_TARGET_DIR:-target}/cuda-stub"
cust=$(CUDA_LIBRARY_PATH=${CARGO_TARGET_DIR:-$PWD/target}/cuda-stub cargo test --release --package optix-cust-tests \
    --features cust --test cust --no-run --message-format=json | grep -o '"executable":"[^"]*"' | cut -d'"' -f4)
strip -o bundle/tests/cust "$cust"
cargo build --release --package examples --package optix-toolchain --features optix-toolchain/cli
target=${CARGO_TARGET_DIR:-target}/release
for program in path-tracer cargo-optix; do
    strip -o "bundle/$program" "$target/$program"
done
# Launch times against CUDA C++, where nvcc and the headers of OptiX are there to compile it: see tests/peers/build.sh.
if [ -n "${OPTIX_INCLUDE:-}" ]; then
    tests/peers/build.sh bundle/peers >/dev/null
    launch=$(cargo bench --package optix-peers --bench launch --no-run --message-format=json |
        grep -o '"executable":"[^"]*"' | cut -d'"' -f4)
    strip -o bundle/launch "$launch"
else
    echo "launch times: not bundled, set OPTIX_INCLUDE"
fi
data=${OPTIX_TEST_DATA:-../shared/data}
if [ -d "$data" ]; then cp "$data"/*.obj bundle/data/; fi
cat >bundle/run.sh <<'RUN'
#!/usr/bin/env bash
# Made by tests/gpu.sh: runs the GPU tests. Exit code 0 if all of them passed.
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
out=${1:-$here/out}
mkdir -p "$out"
export OPTIX_TEST_GPU=1 OPTIX_TEST_DATA=$here/data
"$here/cargo-optix" doctor
failed=0
for test in "$here"/tests/*; do
    echo "== $(basename "$test")"
    "$test" --nocapture --test-threads=1 >"$out/$(basename "$test").log" 2>&1 || failed=1
    grep -v '^test .* ok$' "$out/$(basename "$test").log" | tail -n 40
done
if [ -d "$here/peers" ]; then
    echo "== launch times"
    "$here/launch" "$here/peers" 2>&1 | tee "$out/launch.log"
fi
exit $failed
RUN
chmod +x bundle/run.sh
du -sh bundle
