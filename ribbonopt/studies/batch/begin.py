"""What a worker process runs first: `python begin.py FOLDER...`, where its modules are to be found.

Run by its place and not as a module, so that no working folder stands before these; nothing is
imported until they are set. ribbonopt is the one beside this file, which the batch runs too.
"""

import sys

sys.path[:] = sys.argv[1:]

if __name__ == "__main__":
    from importlib.util import module_from_spec, spec_from_file_location
    from pathlib import Path

    if "ribbonopt" not in sys.modules:
        root = Path(__file__).resolve().parents[2]
        found = spec_from_file_location(
            "ribbonopt", root / "__init__.py", submodule_search_locations=[str(root)]
        )
        assert found is not None and found.loader is not None
        sys.modules["ribbonopt"] = module_from_spec(found)
        found.loader.exec_module(sys.modules["ribbonopt"])
    from ribbonopt.signals import ignore_endings

    ignore_endings()  # before all that takes time to import
    from ribbonopt.studies.batch.worker import serve

    serve()
