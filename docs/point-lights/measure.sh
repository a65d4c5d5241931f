# What docs/point-lights.md shows.
# Sourced by run.sh, with $folder and $out set.
need build lab samples test bench
printf 'building the lab, two benchmarks and two tests ...\n'
(cd "$root" && cmake --preset release -D WARPSHADOW_BUILD_BENCH=ON && cmake --preset ci) >/dev/null
release bench_omni_culling
release bench_omni_culling_native
(cd "$root" && cmake --build --preset ci --parallel "$jobs" --target property_cull_test lab_omni) \
    >/dev/null
# The paper's walk, with a light above the views; and a lamp that most views see.
six=cube6,cube6-cull,cube6-efc,dpsm,dpsm-cull,dpsm-pc
walk=(--path walk --view 320x240)
above=point:-1.9,2.7,1.6 lamp=point:0.2,1.97,-0.1
lab "${walk[@]}" --scene interior:600000 --light=$above --frames 20 --map 1024,2048 \
    --methods $six --out "$out/walk-600k"
lab "${walk[@]}" --scene interior:600000 --light=$lamp --frames 6 --map 1024 \
    --methods $six --out "$out/walk-lamp"
lab "${walk[@]}" --scene interior:3000000 --light=$above --frames 3 --map 1024 \
    --methods $six,cube6-gs,cube6-cull-gs,dpsm-gs,dpsm-cull-gs --out "$out/walk-3m"
lab --preset vpl:100000 --out "$out/vpl-100k"
lab --preset vpl:3000000 --out "$out/vpl-3m"
for name in omni_culling omni_culling_native; do
    "$root/build/release/bench/$name" --benchmark_filter='six_faces|^pair_' \
        --benchmark_enable_random_interleaving=true --benchmark_repetitions=5 \
        --benchmark_min_time=0.02 --benchmark_format=json >"$out/$name.json"
done
# 26 classes and types: over a million pairs
WARPSHADOW_TEST_PAIRS=40000 "$root/build/ci/tests/property/cull_test" \
    '*no pair of frusta that meets*' >"$out/oracle.txt"
"$root/build/ci/tests/lab/lab_omni" 'no edge of a cut scene*' >"$out/chord.txt"
python3 "$folder/collect.py" "$out"
python3 "$folder/write_page.py"
