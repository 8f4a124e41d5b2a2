# A measured RGL file: what lobefit reads of it beside the database's own loader; sourced by `run`.
compile_powitacq "$powitacq"
# The loader shows negative values, which colours out of gamut have, as 0.
clipped() { awk -F, '$1 + 0 == $1 { for (c = 5; c <= NF; ++c) if ($c < 0) { $c = 0; ++count }; print }
  END { if (count > 0) print count " values are negative, and 0 in the loader" >"/dev/stderr" }' OFS=,; }
loader() { (cd "$work" && tr , ' ' | ./powitacq "$material"); }

echo "== random pairs of directions, interpolated"
"$(dirname "$lobefit")/rgl_values" "$material" 20000 | clipped >"$work/fit.csv"
loader <"$work/fit.csv" >"$work/values.txt"
python3 "$here/difference.py" "$work/fit.csv" "$work/values.txt"

echo "== samples"
"$lobefit" convert "$material" "$work/samples.csv" >/dev/null
# Where the half vector is the normal a sample is the mean of the table's rows, the loader's value is that of one row.
awk -F, '$1 + 0 == $1 && !($1 - $3 < 1e-4 && $3 - $1 < 1e-4 && ($1 < 1e-4 || cos(($2 - $4) * 3.14159265 / 180) < -0.999999))' \
  "$work/samples.csv" | clipped >"$work/fit.csv"
loader <"$work/fit.csv" >"$work/values.txt"
python3 "$here/difference.py" "$work/fit.csv" "$work/values.txt"

echo "== half vector and viewer along the normal: one pair of directions, a row of the table for each azimuth"
clipped <"$work/samples.csv" 2>/dev/null |
  awk -F, '$1 < 1e-4 && $3 < 1e-4 { printf "lobefit: %.6g %.6g %.6g\n", $5, $6, $7 }'
awk 'BEGIN { for (k = 0; k < 32; ++k) print 2e-8, 359.999 * k / 31 - 179.9995, 0, 0 }' | loader | python3 -c '
import sys
channels = list(zip(*([float(field) for field in line.split()] for line in sys.stdin)))
print("loader, mean:", *(f"{sum(c) / len(c):.6g}" for c in channels))
print("loader, least to largest:", ", ".join(f"{min(c):.6g} to {max(c):.6g}" for c in channels))'
