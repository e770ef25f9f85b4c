"""Classes of one's own that files name as `module:Class`: found beside the file, in the working directory, or installed.

A class that was found travels with the text of its module and of the modules beside it that it imports, so that workers on other
machines need no copy of them.
"""

import ast
import builtins
import hashlib
import importlib
import importlib.util
import inspect
import re
import sys
import traceback
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from importlib.machinery import SourceFileLoader
from pathlib import Path

from .tables import BadFile, nearest
from .warn import PACKAGE

FORM = re.compile(r"[^\W\d]\w*(\.[^\W\d]\w*)*:[^\W\d]\w*")


@dataclass(frozen=True)
class OwnClass:
    """A class by the name `module:Class`; `where` says which file names it. `files` are path and text of its module, first, and
    of those beside it that it imports; none if it is installed."""

    name: str
    where: str
    files: tuple = ()

    def load(self):
        """The class."""
        module, _, wanted = self.name.partition(":")
        known = vars(_module(module, self.files))
        if wanted not in known:
            classes = [name for name, value in known.items() if inspect.isclass(value)]
            file = Path(self.files[0][0]).name if self.files else module
            raise BadFile(f"{self.where}: {file} has no class {wanted}{nearest(wanted, classes)}")
        if not inspect.isclass(known[wanted]):
            raise BadFile(f"{self.where}: {self.name} is a {type(known[wanted]).__name__}, not a class")
        return known[wanted]

    def digest(self):
        """Name and texts in short: of another class, or of one that was changed, it is another one."""
        texts = [self.name, *(text for _, text in self.files)]
        return hashlib.sha256("\n".join(texts).encode()).hexdigest()[:12]


def find(name, folder, where, protocol):
    """The class `module:Class` that a file in a folder names, checked for the methods of `protocol`; `where` in the file is for
    messages."""
    if not FORM.fullmatch(name):
        raise BadFile(f"{where} = {name!r} is not of the form module:Class, such as my_brake:Gentle")
    module = name.partition(":")[0]
    places = dict.fromkeys([Path(folder).resolve(), Path.cwd()])
    files = next((path for path in (there / f"{module.replace('.', '/')}.py" for there in places) if path.is_file()), None)
    if files is None and not _installed(module):
        looked = " and ".join(map(str, places))
        raise BadFile(f"{where}: no module {module}: there is no {module}.py in {looked}, and none is installed")
    found = OwnClass(name, where, tuple(_texts(files, where).items()) if files else ())
    _check(found, protocol)
    return found


def _installed(module):
    """Whether Python itself finds a module."""
    try:
        return importlib.util.find_spec(module) is not None
    except (ImportError, ValueError):
        return False


def _texts(path, where):
    """Path to text of a module and of all beside it that it imports, however indirectly."""
    found, waiting = {}, [path]
    while waiting:
        path = waiting.pop(0)
        if str(path) in found:
            continue
        try:
            found[str(path)] = text = path.read_text(encoding="utf-8")
            tree = ast.parse(text, str(path))
        except (OSError, UnicodeDecodeError) as error:
            raise BadFile(f"{where}: {path}: cannot be read: {error}") from None
        except (SyntaxError, ValueError) as error:
            raise BadFile(f"{where}: {path}:{getattr(error, 'lineno', 1)}: not Python: {getattr(error, 'msg', error)}") from None
        names = [alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names]
        names += [node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module]
        waiting += [beside for beside in (path.with_name(f"{name}.py") for name in names) if beside.is_file()]
    return found


def _check(found, protocol):
    """The class can be loaded and has what the protocol asks for."""
    try:
        own = found.load()
    except BadFile:
        raise
    except (Exception, SystemExit) as error:
        text = " ".join(f"{type(error).__name__}: {error}".split())
        module = found.name.partition(":")[0]
        raise BadFile(f"{found.where}: importing {module} failed: {text} ({place(error)})") from None
    wanted = [name for name in inspect.signature(protocol.step).parameters if name != "self"]
    call = f"step({', '.join(wanted)})"
    if not callable(getattr(own, "step", None)):
        raise BadFile(f"{found.where}: {found.name} has no method {call}")
    try:
        inspect.signature(own.step).bind("self", *wanted)
    except TypeError as error:
        raise BadFile(f"{found.where}: {found.name}: step{inspect.signature(own.step)} is not {call}: {error}") from None
    except ValueError:
        pass  # written in C: it has no signature


def place(error):
    """Where an error was raised: the last line outside of this package, as `file:line in function: text`."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if not f.filename.startswith((PACKAGE, "<frozen"))]
    if not frames:
        return "in the call itself"
    last = frames[-1]
    return f"{Path(last.filename).name}:{last.lineno} in {last.name}" + (f": {last.line}" if last.line else "")


_modules = ContextVar("modules of one's own", default=None)


@contextmanager
def fresh_modules():
    """Classes that are loaded meanwhile share modules that nothing else has: what these keep begins anew."""
    token = _modules.set({})
    try:
        yield
    finally:
        _modules.reset(token)


def _module(name, files):
    """The module of a name, executed anew unless `fresh_modules` has it already: of the texts of its files, or as installed."""
    made = _modules.get() if _modules.get() is not None else {}
    if (name, files) not in made:
        made[name, files] = _made(files) if files else _imported(name)
    return made[name, files]


def _imported(name):
    """An installed module, with all of its package that is written in Python, executed anew; this package itself is not."""
    package = name.partition(".")[0]
    if package != __name__.partition(".")[0]:
        for other, module in list(sys.modules.items()):
            loader = getattr(getattr(module, "__spec__", None), "loader", None)
            if other.partition(".")[0] == package and isinstance(loader, SourceFileLoader):
                del sys.modules[other]
    return importlib.import_module(name)


def _package(name, folder):
    """Loads the package of a name from a folder, if it is there and nowhere else."""
    file = folder / name / "__init__.py"
    if file.is_file() and not _installed(name):
        spec = importlib.util.spec_from_file_location(name, file)
        sys.modules[name] = importlib.util.module_from_spec(spec)
        try:
            spec.loader.exec_module(sys.modules[name])
        except BaseException:
            del sys.modules[name]
            raise


def _made(files):
    """A module of a text, with those beside it that it imports: nobody else finds these, nor do they take the place of others."""
    texts, made = {Path(path).stem: (path, text) for path, text in reversed(files)}, {}

    def module(stem):
        if stem not in made:
            path, text = texts[stem]
            unique = f"{stem}_{hashlib.sha256(text.encode()).hexdigest()[:8]}"
            new = importlib.util.module_from_spec(importlib.util.spec_from_loader(unique, loader=None, origin=path))
            made[stem], sys.modules[unique] = new, new  # where dataclasses look
            vars(new).update(__file__=path, __builtins__=vars(builtins) | {"__import__": import_one})
            try:
                exec(compile(text, path, "exec"), vars(new))
            except BaseException:
                del made[stem], sys.modules[unique]
                raise
        return made[stem]

    def import_one(name, names=None, own=None, wanted=(), level=0):
        if not level and name in texts:
            return module(name)
        if not level:
            _package(name.partition(".")[0], Path(files[0][0]).parent)
        return builtins.__import__(name, names, own, wanted, level)

    return module(Path(files[0][0]).stem)
