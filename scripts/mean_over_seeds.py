#!/usr/bin/env python3
"""Prints a Markdown table of a benchmark with the drives of a scene (name-1, name-2, ...) put together.

usage: mean_over_seeds.py DIR   (folder of a benchmark, holds results.json)

RTE and RRE of a scene are the root mean squares over its drives, which are equally long. Best bold, second underlined.
"""
import json
import sys
from pathlib import Path

NAMES = {"point-to-point": "p2p", "point-to-plane": "p2plane", "gicp": "GICP", "kiss-icp": "KISS-ICP",
         "doppler-icp": "Doppler-ICP", "dynamic-icp": "Dynamic-ICP", "no-vf": "w/o VF", "no-dpp": "w/o DPP",
         "no-dr": "w/o DR"}


def rms(values):
    return (sum(v * v for v in values) / len(values)) ** 0.5


def emphasised(values):
    texts = [f"{v:.4f}" if k == 0 else f"{v:.3f}" for k, v in values]
    ranked = sorted(set(float(text) for text in texts))
    marks = {ranked[0]: "**{}**"}
    if len(ranked) > 1:
        marks[ranked[1]] = "<u>{}</u>"
    return [marks.get(float(text), "{}").format(text) for text in texts]


def main():
    cells = json.loads((Path(sys.argv[1]) / "results.json").read_text())["cells"]
    for title, chosen in (("method", lambda c: c["ablation"] == "none"),
                          ("part left out", lambda c: c["method"] == "dynamic-icp")):
        column = (lambda c: c["method"]) if title == "method" else (lambda c: c["ablation"])
        errors, columns = {}, []
        for cell in filter(chosen, cells):
            scene = cell["sequence"].rpartition("-")[0]
            name = NAMES.get(column(cell), "Full")
            if name not in columns:
                columns.append(name)
            errors.setdefault(scene, {}).setdefault(name, []).append((cell["rte_rmse_m"], cell["rre_rmse_deg"]))
        print(f"| scene | {' | '.join(columns)} |\n|---|{'---|' * len(columns)}")
        for scene, row in errors.items():
            drives = [row[name] for name in columns]
            rte = emphasised([(0, rms([d[0] for d in drive])) for drive in drives])
            rre = emphasised([(1, rms([d[1] for d in drive])) for drive in drives])
            print(f"| {scene} | " + " | ".join(f"{a} / {b}" for a, b in zip(rte, rre)) + " |")
        print()


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main()
