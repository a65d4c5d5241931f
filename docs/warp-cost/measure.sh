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
# beside the papers' tables: in rounds, so that load that comes and goes meets all methods alike
papers=(--scene outdoor,interior,colonnade --tables 512)
milet=("${papers[@]}" --map 512 --view 1024x1024)
rosen=("${papers[@]}" --map 1024 --view 960x540)
for round in 1 2 3; do
    lab "${milet[@]}" --repeat 1 --methods sm,min-sm,dv,rtw-backward,notw,sv \
        --raster rule:2.5,exact --out "$out/milet-$round"
    lab "${rosen[@]}" --repeat 1 --methods sm,rtw-backward \
        --raster none,rule:5,rule:2.5,rule:1 --out "$out/rosen-cutting-$round"
    lab "${rosen[@]}" --repeat 1 --methods rtw-forward,rtw-hybrid \
        --raster none,rule:2.5 --out "$out/rosen-analyses-$round"
done
for raster in none rule:2.5; do
    lab "${rosen[@]}" --path walk --frames 4 --methods sm,rtw-forward,rtw-backward,rtw-hybrid \
        --raster "$raster" --out "$out/rosen-path-$raster"
done
python3 "$folder/write_page.py" --gather "$out"
