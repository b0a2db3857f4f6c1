#!/usr/bin/env python3
"""The results of scripts/benchmark_speed.sh in one table.

usage: summary.py DIR [--markdown]

Reads what is there of scenes.json, sizes.json, open3d.json, kernels.json and memory-*.txt. Standard library only.
"""
import json
import sys
from pathlib import Path
from statistics import median


def read(path):
    return json.loads(path.read_text()) if path.exists() else None


MARKDOWN = "--markdown" in sys.argv


def heading(text):
    print(f"\n{text}" + ("\n" if MARKDOWN else ""))


def show(rows):
    """Columns of even width; the first two are text."""
    if MARKDOWN:
        used = [i for i in range(len(rows[0])) if any(row[i] for row in rows)]
        lines = ["| " + " | ".join(row[i] for i in used) + " |" for row in rows]
        print("\n".join([lines[0], "|---" * len(used) + "|"] + lines[1:]))
        return
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        print("  ".join(cell.ljust(w) if i < 2 else cell.rjust(w) for i, (cell, w) in enumerate(zip(row, widths))))


def number(value, decimals=1):
    return "-" if value is None else f"{value:.{decimals}f}"


def line(what, where, rows, reference):
    """Rows of one setup over several recordings, as one line."""
    p50 = [row["p50_ms"] for row in rows]
    worst = max(rows, key=lambda row: row["p50_ms"])
    speed_ups = [row["speed_up"] for row in rows if row.get("speed_up") is not None]
    memory = [row["work_mib"] for row in rows if "work_mib" in row]
    spread = max(row["p50_ms_largest_of_runs"] / row["p50_ms_least_of_runs"] for row in rows)
    ratios = [row.get("ratio") or (row["p50_ms"] / reference if reference else None) for row in rows]
    return [what, where, number(median(p50)), number(worst["p50_ms"]), worst["name"].split("/")[-1],
            number(max(row["p95_ms"] for row in rows)), number(max(row["p99_ms"] for row in rows)), number(median(ratios) if reference else None, 2),
            number(max(ratios) if reference else None, 2),
            number(median(speed_ups) if speed_ups else None, 2), number(max(memory, default=None), 0),
            number(spread, 2)]


HEAD = ["what", "on", "p50", "worst", "", "p95", "p99", "ratio", "worst", "x threads", "MiB", "spread"]


def setups_of(rows):
    keys = []
    for row in rows:
        key = (row["method"], row["preset"], row["threads"])
        if key not in keys:
            keys.append(key)
    return keys


def whole_scans(scenes, open3d, reference):
    rows = [HEAD]
    for mode in ("instant", "swept"):
        where = f"{mode} scans"
        chosen = [row for row in scenes["rows"] if row["name"].startswith(mode + "/")]
        for method, preset, threads in setups_of(chosen):
            of_setup = [r for r in chosen if (r["method"], r["preset"], r["threads"]) == (method, preset, threads)]
            rows.append(line(f"{method} {preset}, {threads} thread{'s' if threads > 1 else ''}", where, of_setup, reference))
        peers = [row for row in (open3d or {"rows": []})["rows"] if row["name"].startswith(mode + "/")]
        if peers:
            rows.append(line(f"{peers[0]['peer']}, {peers[0]['threads']} threads", where, peers, reference))
    heading("Whole scans over all scenes, ms (p50: median of the scenes; p95, p99: of the worst scene; MiB beside the scans)")
    show(rows)


def sizes_table(sizes):
    heading("Scans of different sizes, p50 in ms")
    names = list(dict.fromkeys(row["name"] for row in sizes["rows"]))
    points = {row["name"]: row["points_mean"] for row in sizes["rows"]}
    rows = [["setup", ""] + [f"{points[name]:.0f}" for name in names] + ["exponent"]]
    exponents = {(g["method"], g["preset"], g["threads"]): g["exponent"] for g in sizes["growth"]}
    for setup in setups_of(sizes["rows"]):
        times = {r["name"]: r["p50_ms"] for r in sizes["rows"] if (r["method"], r["preset"], r["threads"]) == setup}
        rows.append([f"{setup[0]} {setup[1]}", f"threads {setup[2]}"] + [number(times[name]) for name in names]
                    + [number(exponents.get(setup), 2)])
    show(rows)


def kernel_rows(kernels):
    """For each step its times (ns) in all repetitions, and its counters."""
    unit = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}
    rows = {}
    # They are timed in random order and shown in that of the sources.
    for row in sorted(kernels["benchmarks"], key=lambda row: (row["family_index"], row["per_family_instance_index"])):
        if row.get("run_type") == "aggregate":
            continue
        name = row["run_name"].split("/repeats:")[0]
        for suffix in ("/iterations:100", "/process_time", "/real_time", "/manual_time"):
            name = name.replace(suffix, "")
        rows.setdefault(name, ([], row))[0].append(row["real_time"] * unit[row["time_unit"]])
    return rows


def floor_costs(rows):
    """ns of a byte in order, of a cache line at a random place of a table of 2 MiB, and of an operation; one thread."""
    def cost(name, counter):
        times, counters = rows.get(name, ([], {}))
        return min(times) / counters[counter] if times and counters.get(counter) else 0.0
    return {"bytes": cost("floor_memory_read/threads:1", "bytes"),
            "lines": cost("floor_random_throughput/MiB:2", "lines"),
            "operations": cost("floor_arithmetic", "operations")}


def kernels_table(kernels):
    heading("Single steps. All but the median from the least time of the repetitions. Floor: the largest of the times "
            "that the\nbytes, lines and operations of the step take at the speeds of the floor on one thread")
    rows = kernel_rows(kernels)
    costs = floor_costs(rows)
    table = [["step", "", "median us", "least us", "ns an item", "floor us", "by", "times the floor"]]
    for name, (times, counters) in rows.items():
        least, items = min(times), counters.get("items", 0.0)
        floors = {what: counters.get(what, 0.0) * cost for what, cost in costs.items()}
        by = max(floors, key=floors.get)
        stated = counters.get("operations", 0.0) > 0.0 and not name.startswith("floor_") and floors[by] > 0.0
        table.append([name, "", number(median(times) / 1e3, 1), number(least / 1e3, 1),
                      number(least / items if items else None, 2), number(floors[by] / 1e3 if stated else None, 1),
                      by if stated else "-", number(least / floors[by] if stated else None, 1)])
    show(table)


def memory_table(folder):
    files = sorted(folder.glob("memory-*.txt"))
    if not files:
        return
    heading("Resident memory of a long run, MiB")
    table = [["preset", "", "at 10 %", "at 50 %", "at the end", "largest", "seconds"]]
    for file in files:
        samples = [tuple(map(float, text.split())) for text in file.read_text().splitlines() if not text.startswith("#")]
        if samples:
            at = [samples[int(share * (len(samples) - 1))][1] for share in (0.1, 0.5, 1.0)]
            table.append([file.stem.removeprefix("memory-"), ""] + [number(value, 0) for value in at]
                         + [number(max(sample[1] for sample in samples), 0), number(samples[-1][0], 0)])
    show(table)


def main():
    folder = Path(sys.argv[1])
    scenes, sizes, open3d, kernels = (read(folder / f"{name}.json") for name in ("scenes", "sizes", "open3d", "kernels"))
    reference = scenes["reference"]["ms"] if scenes and scenes["reference"] else None
    if scenes:
        print(scenes["machine"])
        if reference:
            print(f"reference work {reference:.2f} ms ({scenes['reference']['ms_least_of_runs']:.2f}-"
                  f"{scenes['reference']['ms_largest_of_runs']:.2f})")
        whole_scans(scenes, open3d, reference)
    if sizes:
        sizes_table(sizes)
    if kernels:
        kernels_table(kernels)
    memory_table(folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
