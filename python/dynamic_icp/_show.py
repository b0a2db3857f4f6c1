# Copyright (c) 2026 The Dynamic-ICP developers
# SPDX-License-Identifier: MIT
"""How results show themselves in notebooks, and what is only there where other packages are."""

from __future__ import annotations

import html
import importlib
from typing import Any, Sequence


COLOURS = {"static": "#7a7a7a", "trajectory": "#1f77b4", "ground_truth": "#2ca02c", "moving": "#d62728"}


def table_html(rows: Sequence[Sequence[str]], head: Sequence[str] = ()) -> str:
    """Rows of text as an HTML table; whatever is in them is shown as text."""

    def line(cells: Sequence[str], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells) + "</tr>"

    body = "".join(line(row, "td") for row in rows)
    return f"<table>{line(head, 'th') if head else ''}{body}</table>"


class HtmlTable:
    """Shows itself as a table of names and values."""

    def _rows(self) -> list[tuple[str, str]]:
        raise NotImplementedError

    def _repr_html_(self) -> str:
        return table_html(self._rows())


def needed(module: str, what_for: str) -> Any:
    """Imports an optional package, or says what it is needed for."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ImportError(f"{what_for} needs {module.split('.')[0]}, which is not installed") from error


def axes_or_new(ax: Any, **options: Any) -> Any:
    """The axes of matplotlib that are given, or new ones."""
    return needed("matplotlib.pyplot", "plot()").subplots(**options)[1] if ax is None else ax


def metres(values: Any) -> str:
    """A short vector in a few digits."""
    return ", ".join(f"{float(value):.3f}" for value in values)


