# What docs/geometry.md shows; its speeds want an idle machine.
# Sourced by run.sh, with $folder and $out set.
need build lab samples test bench
bench=$root/build/release/bench
(cd "$root" && cmake --preset release -D WARPSHADOW_BUILD_BENCH=ON) >/dev/null
for name in geometry_failures geometry_fits geometry_bench geometry_bench_native; do
    printf 'building %s ...\n' "$name"
    release "bench_$name"
done
"$bench/geometry_fits" "$folder/fits.json" "$folder/fit.svg"
printf 'counting failures ...\n'
WARPSHADOW_SETS=400 "$bench/geometry_failures" "$out/failures.md" "$folder/failures.json"
for name in geometry_bench geometry_bench_native; do
    printf 'timing %s ...\n' "$name"
    "$bench/$name" --benchmark_enable_random_interleaving=true --benchmark_repetitions=15 \
        --benchmark_min_time=0.005 --benchmark_out="$out/$name.json" >/dev/null
done
python3 "$folder/collect.py" speed "$out/geometry_bench.json" "$out/geometry_bench_native.json"
lab --methods sm,stable,min-sm,dv --out "$out/lab"
python3 "$folder/collect.py" frames "$out/lab/results.json"
python3 "$folder/write_page.py"
