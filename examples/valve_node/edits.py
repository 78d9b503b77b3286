# SPDX-License-Identifier: Apache-2.0
"""Programs with one fault each: an edit of their source, as somebody might have written it."""
import argparse
import pathlib
import sys


def run(program, faults):
    """Runs `program` with what --fault NAME edits. faults: name -> (what it does, the case that finds it, old text,
    new text, and more such pairs)."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--fault", choices=faults, help="; ".join(f"{name}: {row[0]}" for name, row in faults.items()))
    parser.add_argument("--list-faults", action="store_true", help="name, case that finds it, what it does")
    asked = parser.parse_args()
    if asked.list_faults:
        for name, (what, case, *_) in faults.items():
            print(name, case, what)
        return
    path = pathlib.Path(program)
    source = path.read_text()
    edits = iter(faults[asked.fault][2:] if asked.fault else ())
    for old, new in zip(edits, edits):
        if source.count(old) != 1:
            sys.exit(f"{program} has {source.count(old)} times: {old}")
        source = source.replace(old, new)
    sys.argv = [str(path)]
    exec(compile(source, str(path), "exec"), {"__name__": "__main__", "__file__": str(path)})
