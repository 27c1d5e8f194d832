"""The Python package as a page: what `__all__` of it names, with signatures, fields and docstrings."""

import ast
import re
from pathlib import Path

import pages

# Of methods with two underscores those that one would look up; the others go without saying.
_TOLD = {"__init__", "__call__", "__getitem__", "__len__"}


def page(folder):
    """Of its modules; of one with a stub, NAME.pyi, the stub is read."""
    folder = Path(folder)
    package = ast.parse((folder / "__init__.py").read_text(encoding="utf-8"))
    names = next(ast.literal_eval(node.value) for node in package.body
                 if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__")  # fmt: skip
    out = ["# Python: `import kerf`\n", *_docstring(package)]
    for path in sorted({path.with_suffix("") for path in folder.glob("[!_]*.py*") if path.suffix in {".py", ".pyi"}}):
        source = path.with_suffix(".pyi" if path.with_suffix(".pyi").exists() else ".py").read_text(encoding="utf-8")
        module = ast.parse(source)
        told = [line for node in module.body if getattr(node, "name", None) in names for line in _entry(node, source, "###", "kerf.")]
        if told:
            out += [f"## {path.name}\n", *_docstring(module), *told]
    return "\n".join(out)


def _docstring(node):
    """With the fields of reStructuredText as a list."""
    text = ast.get_docstring(node)
    if not text:
        return []
    text = re.sub(r"^(?!    ).+$", lambda line: pages.linked(line[0], "../"), text, flags=re.MULTILINE)
    text = re.sub(r"^:param ([\w, ]+):", r"- `\1`:", text, flags=re.MULTILINE)
    text = re.sub(r"^:raises? ([\w.]+):", r"- raises `\1`:", text, flags=re.MULTILINE)
    text = re.sub(r"^:(returns?):", r"- \1:", text, flags=re.MULTILINE)
    return [re.sub(r"^(?!- | )(.+)\n(?=- )", r"\1\n\n", text, flags=re.MULTILINE) + "\n"]  # a list begins after a blank line


def _entry(node, source, hashes, of):
    """A class with what it has, or a function."""
    if isinstance(node, ast.ClassDef):
        bases = f"({', '.join(ast.unparse(base) for base in node.bases)})" if node.bases else ""
        # As they stand there, with their comments.
        lines = source.splitlines()
        fields = ["\n".join(lines[item.lineno - 1:item.end_lineno]) for item in node.body
                  if isinstance(item, ast.AnnAssign) and not ast.unparse(item.target).startswith("_")]  # fmt: skip
        code = "\n".join([f"class {node.name}{bases}{':' if fields else ''}", *fields])
        own = [line for item in node.body for line in _entry(item, source, hashes + "#", f"{of}{node.name}.")]
    elif isinstance(node, ast.FunctionDef) and (not node.name.startswith("_") or node.name in _TOLD):
        answer = f" -> {ast.unparse(node.returns)}" if node.returns else ""
        marks = {ast.unparse(mark) for mark in node.decorator_list}
        code, own = f"{node.name}({ast.unparse(node.args)}){answer}", []
        if marks & {"property", "functools.cached_property", "cached_property"}:
            code = f"{node.name}{answer.replace(' -> ', ': ')}"
        elif marks & {"classmethod", "staticmethod"}:
            code = f"@{(marks & {'classmethod', 'staticmethod'}).pop()}\n{code}"
    else:
        return []
    return [f"{hashes} `{of}{node.name}`\n", f"```python\n{code}\n```\n", *_docstring(node), *own]
