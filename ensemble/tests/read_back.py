"""Parts as polars, pandas and DuckDB read them: python read_back.py FOLDER"""

import sys

import duckdb
import pandas
import polars

files = f"{sys.argv[1]}/members-*.parquet"
by_polars = polars.read_parquet(files).sort("member")
by_pandas = pandas.read_parquet(sys.argv[1]).sort_values("member").reset_index(drop=True)
by_duckdb = duckdb.sql(f"select * from '{files}' order by member").df()

assert by_polars.columns == list(by_pandas.columns) == list(by_duckdb.columns)
assert by_polars["member"].to_list() == list(range(len(by_polars)))
for name in by_polars.columns[:-1]:
    assert (by_polars[name].to_numpy() == by_pandas[name].to_numpy()).all(), name
    assert (by_polars[name].to_numpy() == by_duckdb[name].to_numpy()).all(), name
assert by_polars["error"].null_count() == len(by_polars)

# The energy, from the other columns.
q, p = (by_polars.select(f"{of}0", f"{of}1").to_numpy() for of in "qp")
energy = (p**2).sum(axis=1) / 2 - 1 / (q**2).sum(axis=1) ** 0.5
assert abs(energy - by_polars["energy"].to_numpy()).max() < 1e-13
print(f"{len(by_polars)} members read back by polars, pandas and DuckDB: the same values")
