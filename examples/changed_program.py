"""A program of several modules in which a line is changed: how an implementation is given a fault."""
import argparse
import pathlib
import sys
import types


def run(folder, modules, faults):
    """Runs the last one of `modules`, which import those before. --fault NAME makes the changes of faults[NAME], (what
    it does, the case that finds it, (text, other text)...); --list-faults prints these."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--fault", choices=faults, metavar="NAME")
    parser.add_argument("--list-faults", action="store_true", help="name, case that finds it, what it does")
    asked = parser.parse_args()
    if asked.list_faults:
        for name, (what, case, *_) in faults.items():
            print(name, case, what)
        return
    texts = [(pathlib.Path(folder) / f"{module}.py").read_text() for module in modules]
    for old, new in faults[asked.fault][2:] if asked.fault else ():
        if sum(text.count(old) for text in texts) != 1:
            sys.exit(f"{asked.fault}: {old!r} is not there exactly once")
        texts = [text.replace(old, new) for text in texts]
    for module, text in zip(modules, texts):
        name = "__main__" if module == modules[-1] else module
        sys.modules[name] = loaded = types.ModuleType(name)
        exec(compile(text, f"{module}.py", "exec"), loaded.__dict__)
