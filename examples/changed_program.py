"""A program of several modules in which a line is changed: how an implementation is given a fault."""
import argparse
import pathlib
import sys
import types


def run(folder, modules, faults):
    """Runs the last one of `modules`, which import those before. --fault NAME makes the changes of faults[NAME], (what
    it does, the case that finds it, text, other text, and more such pairs); --list-faults prints these."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--fault", choices=faults, metavar="NAME")
    parser.add_argument("--list-faults", action="store_true", help="name, case that finds it, what it does")
    asked = parser.parse_args()
    if asked.list_faults:
        for name, (what, case, *_) in faults.items():
            print(name, case, what)
        return
    files = [pathlib.Path(folder) / f"{module}.py" for module in modules]
    texts = [file.read_text() for file in files]
    edits = iter(faults[asked.fault][2:] if asked.fault else ())
    for old, new in zip(edits, edits):
        if sum(text.count(old) for text in texts) != 1:
            sys.exit(f"{asked.fault}: {old!r} is not there exactly once")
        texts = [text.replace(old, new) for text in texts]
    sys.argv = sys.argv[:1]
    for module, file, text in zip(modules, files, texts):
        name = "__main__" if module == modules[-1] else module
        sys.modules[name] = loaded = types.ModuleType(name)
        loaded.__file__ = str(file)
        exec(compile(text, str(file), "exec"), loaded.__dict__)
