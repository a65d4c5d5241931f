# What docs/rasterising.md shows.
# Sourced by run.sh, with $folder and $out set.
scenes=outdoor,interior,colonnade,leaves
lab --scene $scenes --view 512x384 --repeat 1 --methods dv,notw \
    --raster none,fragment,rule:5,rule:2.5,rule:1,bound:0.5,hull,exact,ideal --out "$out/chain"
cp "$out/chain/results.json" "$folder/chain.json"
lab --scene $scenes --camera 0 --camera 1 --light 0 --light 1 --view 512x384 --repeat 1 \
    --map 512,1024 --methods dv,notw --out "$out/views"
cp "$out/views/results.json" "$folder/views.json"
lab --preset figure7 --repeat 3 --out "$out/figure7"
python3 "$folder/write_page.py" --figure "$out/figure7"
command_bench warp_folds "$folder/folds.json"
python3 "$folder/write_page.py"
