"""The stub of the module says what the module has, no more and no less; everything public has a docstring."""

import ast
import inspect
import re
import unittest
from pathlib import Path

import feldspar
import feldspar.meshes
import feldspar.plots
from feldspar import _core

STUB = Path(inspect.getfile(feldspar)).parent / "_core.pyi"


def parameters_of(function):
    """Names of the parameters of a pybind11 function, from the first line of its docstring, and which of them are by keyword only."""
    signature = function.__doc__.splitlines()[0]
    inside = signature[signature.index("(") + 1 : signature.rindex(")")]
    depth, words, word = 0, [], ""
    for c in inside:
        depth += c in "[({<"
        depth -= c in "])}>"
        if c == "," and depth == 0:
            words.append(word)
            word = ""
        else:
            word += c
    words.append(word)
    names = [re.split(r"[:=]", w.strip())[0].strip() for w in words if w.strip()]
    return [n for n in names if n not in ("self",)]


class Stubs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.tree = ast.parse(STUB.read_text(encoding="utf-8"))
        cls.classes = {node.name: node for node in cls.tree.body if isinstance(node, ast.ClassDef)}
        cls.functions = {node.name: node for node in cls.tree.body if isinstance(node, ast.FunctionDef)}
        cls.variables = {node.target.id for node in cls.tree.body if isinstance(node, ast.AnnAssign)}

    def test_names_are_those_of_the_module(self):
        public = {name for name in dir(_core) if not name.startswith("_")}
        stubbed = set(self.classes) | set(self.functions) | {v for v in self.variables if not v.startswith("_")}
        self.assertEqual(public, stubbed)

    def test_members_are_those_of_the_classes(self):
        special = {"__len__", "__eq__"}
        for name, node in self.classes.items():
            of_module = {m for m in vars(getattr(_core, name)) if not m.startswith("_") or m in special}
            of_stub = {member.name for member in node.body if isinstance(member, ast.FunctionDef)}
            self.assertEqual(of_module, of_stub, name)
            for member in node.body:
                is_property = any(isinstance(d, ast.Name) and d.id == "property" for d in member.decorator_list)
                self.assertEqual(is_property, isinstance(vars(getattr(_core, name))[member.name], property), f"{name}.{member.name}")

    def check_parameters(self, node, function, what):
        of_stub = [a.arg for a in node.args.args if a.arg != "self"] + (["*"] if node.args.kwonlyargs else []) + [a.arg for a in node.args.kwonlyargs]
        self.assertEqual(parameters_of(function), of_stub, what)

    def test_parameters_are_those_of_the_functions(self):
        for name, node in self.functions.items():
            self.check_parameters(node, getattr(_core, name), name)
        for name, node in self.classes.items():
            for member in node.body:
                function = getattr(getattr(_core, name), member.name)
                if not isinstance(function, property) and not member.name.startswith("__"):
                    self.check_parameters(member, function, f"{name}.{member.name}")

    def test_everything_has_a_docstring(self):
        for name in set(self.classes) | set(self.functions):
            self.assertTrue(inspect.getdoc(getattr(_core, name)), name)
        for name in self.classes:
            for member, value in vars(getattr(_core, name)).items():
                if not member.startswith("_"):
                    text = (value.__doc__ if isinstance(value, property) else inspect.getdoc(getattr(getattr(_core, name), member))) or ""
                    body = text if isinstance(value, property) else "\n".join(text.splitlines()[1:])
                    self.assertTrue(body.strip(), f"{name}.{member}")
        for module in (feldspar, feldspar.errors, feldspar.files, feldspar.meshes, feldspar.plots, feldspar.progress, feldspar.results, feldspar.tables):
            self.assertTrue(module.__doc__)
            for name in module.__all__:
                value = getattr(module, name)
                if inspect.isclass(value) or inspect.isfunction(value):
                    self.assertTrue(inspect.getdoc(value), f"{module.__name__}.{name}")

    def test_what_is_written_in_python_is_annotated(self):
        for module in (feldspar, feldspar.errors, feldspar.files, feldspar.meshes, feldspar.plots, feldspar.progress, feldspar.results, feldspar.tables):
            tree = ast.parse(Path(inspect.getfile(module)).read_text(encoding="utf-8"))
            for node in ast.walk(tree):
                if isinstance(node, ast.FunctionDef) and not node.name.startswith("__"):
                    self.assertIsNotNone(node.returns, f"{module.__name__}.{node.name}")
                    for argument in node.args.args + node.args.kwonlyargs:
                        self.assertTrue(argument.arg == "self" or argument.annotation is not None, f"{module.__name__}.{node.name}({argument.arg})")


if __name__ == "__main__":
    unittest.main()
