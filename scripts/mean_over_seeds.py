#!/usr/bin/env python3
"""Prints Markdown tables of benchmarks with the drives of a scene (name-1, name-2, ...) put together.

usage: mean_over_seeds.py DIR...   (folders of benchmarks over the same drives; each holds results.json)

First the methods of all folders side by side by RTE (mm) and RRE (degrees): root mean squares over the drives of a
scene, which are equally long. Then by the medians of each drive, as mean over the drives: a few motions that are
lost, as the first ones often are, decide the root mean square and leave the median alone. Then the stated covariances: mean NEES of
rotation and of translation, 3 is right, and the share of scans with status ok beyond four stated standard deviations.
Last for each folder what Dynamic-ICP loses without its parts. Best bold, second underlined.
"""
import json
import sys
from pathlib import Path

NAMES = {"point-to-point": "p2p", "point-to-plane": "p2plane", "gicp": "GICP", "kiss-icp": "KISS-ICP",
         "doppler-icp": "Doppler-ICP", "none": "Full", "no-vf": "w/o VF", "no-dpp": "w/o DPP", "no-dr": "w/o DR"}


def mean(cells, key):
    return sum(cell[key] for cell in cells) / len(cells)


def rms(cells, key):
    return (sum(cell[key] ** 2 for cell in cells) / len(cells)) ** 0.5


def millimetres(metres):
    return f"{1000 * metres:.{2 if metres < 0.01 else 1 if metres < 0.1 else 0}f}"


def emphasised(texts):
    ranked = sorted(set(float(text) for text in texts))
    marks = {ranked[0]: "**{}**"}
    if len(ranked) > 1:
        marks[ranked[1]] = "<u>{}</u>"
    return [marks.get(float(text), "{}").format(text) for text in texts]


def print_table(rows, kind="rmse", over_drives=rms):
    """rows: scene -> column -> cells of results.json"""
    columns = list(dict.fromkeys(name for row in rows.values() for name in row))
    print(f"| scene | {' | '.join(columns)} |\n|---|{'---|' * len(columns)}")
    for scene, row in rows.items():
        rte = emphasised([millimetres(over_drives(row[name], f"rte_{kind}_m")) for name in columns])
        rre = emphasised([f"{over_drives(row[name], f'rre_{kind}_deg'):.4f}" for name in columns])
        print(f"| {scene} | " + " | ".join(f"{a} / {b}" for a, b in zip(rte, rre)) + " |")
    print()


def three_digits(number):
    return f"{number:.0f}" if number >= 100 else f"{number:.3g}"


def consistency(cells):
    """Means over the drives; a dash where one of them states no covariance."""
    means = []
    for key in ("nees_rotation", "nees_translation", "beyond_4_sigma"):
        means.append(None if any(cell[key] is None for cell in cells) else mean(cells, key))
    texts = ["-" if nees is None else three_digits(nees) for nees in means[:2]]
    return " / ".join([*texts, "-" if means[2] is None else f"{100 * means[2]:.0f} %"])


def print_consistency(rows):
    columns = list(dict.fromkeys(name for row in rows.values() for name in row))
    print(f"| scene | {' | '.join(columns)} |\n|---|{'---|' * len(columns)}")
    for scene, row in rows.items():
        print(f"| {scene} | " + " | ".join(consistency(row[name]) for name in columns) + " |")
    print()


def cells_of(folder, benchmark):
    """The cells with all numbers of the summaries of their runs."""
    for cell in benchmark["cells"]:
        summary = Path(folder) / cell["folder"] / "run" / "summary.json"
        yield {**json.loads(summary.read_text()), **cell} if cell["finished"] else cell


def collect(rows, cells, name_of):
    for cell in cells:
        if cell["rte_rmse_m"] is None:
            sys.exit(f"{cell['sequence']}, {cell['method']}: this run failed or has no truth")
        scene = cell["sequence"].rpartition("-")[0]
        rows.setdefault(scene, {}).setdefault(name_of(cell), []).append(cell)


def main():
    benchmarks = [json.loads((Path(folder) / "results.json").read_text()) for folder in sys.argv[1:]]
    methods = {}
    for folder, benchmark in zip(sys.argv[1:], benchmarks):
        ours = f"Dynamic-ICP, {benchmark['info']['preset']}"
        collect(methods, [c for c in cells_of(folder, benchmark) if c["ablation"] == "none"],
                lambda c: ours if c["method"] == "dynamic-icp" else NAMES[c["method"]])
    print_table(methods)
    print_table(methods, "median", mean)
    print_consistency(methods)
    for benchmark in benchmarks:
        parts = {}
        collect(parts, [c for c in benchmark["cells"] if c["method"] == "dynamic-icp"],
                lambda c: NAMES.get(c["ablation"], c["ablation"].replace("no-", "w/o ")))
        if parts and len(next(iter(parts.values()))) > 1:
            print(f"Preset {benchmark['info']['preset']}\n")
            print_table(parts)


if __name__ == "__main__":
    if {"-h", "--help"} & set(sys.argv[1:]):
        print(__doc__)
        sys.exit()
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for folder in sys.argv[1:]:
        if not (Path(folder) / "results.json").is_file():
            sys.exit(f"{folder}: no folder of a benchmark: it holds no results.json")
    main()
