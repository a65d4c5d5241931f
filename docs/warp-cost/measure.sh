# What docs/warp-cost.md shows; its times want an idle machine.
# Sourced by run.sh, with $folder and $out set.
need build lab samples test bench
(cd "$root" && cmake --preset release -D WARPSHADOW_BUILD_BENCH=ON) >/dev/null
for name in passes_bench warp_build_bench warp_build_bench_native; do
    printf 'building %s ...\n' "$name"
    release "bench_$name"
done
bench=$root/build/release/bench
"$bench/passes_bench" 5 tables "$out/passes.json"
for name in warp_build_bench warp_build_bench_native; do
    printf 'timing %s ...\n' "$name"
    "$bench/$name" --benchmark_enable_random_interleaving=true --benchmark_repetitions=3 \
        --benchmark_min_time=0.02 --benchmark_format=json >"$out/$name.json"
done
python3 "$folder/write_page.py" --gather "$out"
