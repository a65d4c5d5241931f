# What docs/lispsm.md shows of LiSPSM and the fitted warp.
# Sourced by run.sh, with $folder and $out set.
small=(--view 512x384 --repeat 1)
command_bench lispsm_accuracy "$out/accuracy.md" "$out/accuracy.json"
for scene in outdoor interior colonnade leaves; do
    lab --scene "$scene" --camera 0 --camera 1 --light 0 --light 1 --map 512,1024 \
        --methods sm,dv,sdsm,fitted,fitted-2 "${small[@]}" --out "$out/views-$scene"
done
# per camera two suns at right angles to its view and two behind it
pairs=(
    0.3,1.593,4.5,-1.1,0.4926,-9,55
    "0.801,-0.598,-0.034 -0.44,-0.887,0.118 -0.073,-0.703,-0.708 0.002,-0.336,-0.947"
    34,26,30,-8,0,-55,50
    "0.788,-0.579,-0.212 -0.299,-0.858,0.41 -0.252,-0.822,-0.51 -0.293,-0.505,-0.818"
    0.792,1.621,-16,-16,2,-36,55
    "0.607,-0.6,-0.521 -0.353,-0.89,0.279 -0.499,-0.632,-0.594 -0.547,-0.245,-0.807"
    34,26,30,-30,0,20,50
    "0.344,-0.557,-0.756 0.258,-0.826,0.496 -0.466,-0.882,-0.073 -0.775,-0.6,-0.222"
)
for ((i = 0; i < ${#pairs[@]}; i += 2)); do
    suns=()
    for sun in ${pairs[i + 1]}; do
        suns+=(--light "sun:$sun")
    done
    lab --scene outdoor --camera="${pairs[i]}" "${suns[@]}" --methods sm,min-sm,lispsm \
        --map 1024 "${small[@]}" --out "$out/pairs-$i"
done
for path in yaw walk; do
    lab --scene outdoor --path "$path" --frames 24 --methods sm,dv,fitted,fitted-2 \
        --map 1024 "${small[@]}" --out "$out/path-$path"
done
python3 "$folder/write_page.py" --gather "$out"
