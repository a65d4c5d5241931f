# What docs/accuracy.md shows; its times want an idle machine.
# Sourced by run.sh, with $folder and $out set.
lab --sweep short --out "$out"
python3 "$folder/write_page.py" --gather "$out/results.json"
