"""`python -m slipgym` is the command `slipgym`, which belongs to the package policies."""

from importlib import import_module

from slipgym.beside import refuse_hidden

COMMAND = "policies.commands.front"

if __name__ == "__main__":
    try:
        for name in ("estimator", "policies"):
            refuse_hidden(name)
        front = import_module(COMMAND)
    except ModuleNotFoundError as error:
        if error.name not in {"policies", "policies.commands", COMMAND}:
            raise
        raise SystemExit(
            f"the command slipgym needs the package {error.name}: pip install slipgym"
        ) from error
    except ImportError as error:
        raise SystemExit(f"slipgym: {error}") from error
    front.main()
