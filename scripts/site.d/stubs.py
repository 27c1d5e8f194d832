"""The stubs of the Python package as a page: signatures and docstrings."""

import ast


def page(paths):
    out = ["# Python: `import kerf`\n"]
    for path in paths:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        out.append(f"## {'kerf' if path.stem == '__init__' else f'kerf.{path.stem}'}\n")
        out += _told(tree)
        out += [line for node in tree.body for line in _entry(node, "###", "")]
    return "\n".join(out)


def _told(node):
    text = ast.get_docstring(node)
    return [text + "\n"] if text else []


def _entry(node, hashes, of):
    """A class with what it has, or a function; of one that has several signatures each."""
    if not isinstance(node, (ast.ClassDef, ast.FunctionDef)) or (node.name.startswith("_") and node.name != "__init__"):
        return []
    if isinstance(node, ast.ClassDef):
        bases = f"({', '.join(ast.unparse(base) for base in node.bases)})" if node.bases else ""
        fields = [f"    {ast.unparse(item)}" for item in node.body if isinstance(item, ast.AnnAssign)]
        code = "\n".join([f"class {node.name}{bases}:", *fields]) if fields else f"class {node.name}{bases}"
        own = [line for item in node.body for line in _entry(item, hashes + "#", node.name + ".")]
    else:
        answer = f" -> {ast.unparse(node.returns)}" if node.returns else ""
        code, own = f"{node.name}({ast.unparse(node.args)}){answer}", []
        if any(isinstance(mark, ast.Name) and mark.id == "property" for mark in node.decorator_list):
            code = f"{node.name}{answer.replace(' -> ', ': ')}"
    return [f"{hashes} `{of}{node.name}`\n", f"```python\n{code}\n```\n", *_told(node), *own]
