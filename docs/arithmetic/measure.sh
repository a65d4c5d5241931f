# What docs/arithmetic.md shows; its times want an idle machine.
# Sourced by run.sh, with $folder and $out set.
need build test bench lab
printf 'building the benchmark ...\n'
(cd "$root" && cmake --preset release -D WARPSHADOW_BUILD_BENCH=ON) >/dev/null
release bench_arithmetic
printf 'measuring ...\n'
"$root/build/release/bench/arithmetic" "$folder/arithmetic.json" 25
python3 "$folder/write_page.py"
