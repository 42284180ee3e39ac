"""`python -m slipgym` is the command `slipgym`, which belongs to the package policies."""

from importlib import import_module

COMMAND = "policies.commands.front"

if __name__ == "__main__":
    try:
        front = import_module(COMMAND)
    except ModuleNotFoundError as error:
        if error.name not in {"policies", "policies.commands", COMMAND}:
            raise
        raise SystemExit(
            f"the command slipgym needs the package {error.name}: pip install slipgym"
        ) from error
    front.main()
