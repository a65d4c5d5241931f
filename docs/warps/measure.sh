# What docs/warps.md shows.
# Sourced by run.sh, with $folder and $out set.
lab --scene outdoor,interior,colonnade,leaves --camera 0 --camera 1 --light 0 --light 1 \
    --methods sm,dv,fitted,rtw-forward,rtw-backward,rtw-hybrid,notw,notw-fine,notw-edges,notw-oracle,notw-hybrid \
    --map 512 --view 512x384 --repeat 1 --out "$out"
python3 "$folder/write_page.py" --from "$out/results.json"
