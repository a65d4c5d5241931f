# The pictures and the table of README.md.
# Sourced by run.sh, with $folder and $out set.
lab --methods sm,dv,fitted,notw,notw-hybrid,raytraced --out "$out"
cp "$out/results.json" "$folder/results.json"
for method in sm notw-hybrid; do
    cp "$out/outdoor-c0-l0-m512-$method.png" "$folder/outdoor-$method.png"
done
python3 "$folder/write_readme.py"
