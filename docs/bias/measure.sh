# Figures 6 and 8 of Scherzer 2005, as docs/bias.md shows them.
# Sourced by run.sh, with $folder and $out set.
for figure in figure6 figure8; do
    lab --preset "$figure" --out "$out/$figure"
    cp "$out/$figure/results.json" "$folder/$figure.json"
done
python3 "$folder/write_page.py"
