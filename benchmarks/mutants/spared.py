"""Stretches of a file that do nothing when it runs, or nothing but compile: no test could find a fault in them."""

from __future__ import annotations

import ast

#: Line (from 1) and column (from 0).
Place = tuple[int, int]


def without_effect(module: ast.Module) -> list[tuple[Place, Place]]:
    """List where such stretches begin and end: annotations, imports for types alone, decorators of the compiler."""
    nodes: list[ast.AST | None] = []
    for node in ast.walk(module):
        match node:
            case ast.AnnAssign() | ast.arg():
                nodes.append(node.annotation)
            case ast.FunctionDef():
                compiling = [
                    mark for mark in node.decorator_list if "njit" in ast.unparse(mark) or "overload" in ast.unparse(mark)
                ]
                nodes += [node.returns, *compiling]
            case ast.If() if ast.unparse(node.test) == "TYPE_CHECKING":
                nodes.append(node)
            case ast.Assign() if "NDArray" in ast.unparse(node.value):
                nodes.append(node)
    kept = [node for node in nodes if isinstance(node, ast.expr | ast.stmt)]
    # A decorator begins at its @, one column before its expression.
    return [((n.lineno, max(n.col_offset - 1, 0)), (int(n.end_lineno or 0), int(n.end_col_offset or 0) + 1)) for n in kept]
