"""Runs the notebooks of examples/ in place, with their output; needs nbclient and ipykernel."""

import sys
from importlib import import_module
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
FILES = "https://raw.githubusercontent.com/slipgym/slipgym/main/examples"
INSTALL = f"""\
import subprocess
import sys
from importlib.util import find_spec
from urllib.request import urlretrieve

if find_spec("slipgym") is None:  # in a cloud notebook
    subprocess.run([sys.executable, "-m", "pip", "install", "-q", "slipgym[eval]"], check=True)
    for name in ("columns.yaml", "linear_slip_wood.csv.gz"):
        urlretrieve(f"{FILES}/{{name}}", name)"""
"""First cell of code of each notebook."""


def main() -> None:
    """Run each notebook and keep text and pictures, without times and counters of the run."""
    nbformat, client = import_module("nbformat"), import_module("nbclient")
    for path in sorted(EXAMPLES.glob("*.ipynb")):
        notebook = nbformat.read(path, as_version=4)
        if notebook.cells[1].source != INSTALL:
            notebook.cells.insert(1, nbformat.v4.new_code_cell(INSTALL))
        client.NotebookClient(
            notebook, timeout=900, resources={"metadata": {"path": str(EXAMPLES)}}
        ).execute()
        notebook.metadata = {"kernelspec": {"name": "python3", "display_name": "Python 3"}}
        for k, cell in enumerate(notebook.cells):
            cell.id, cell.metadata = f"cell-{k}", {}
            if cell.cell_type == "code":
                cell.execution_count = None
                cell.outputs = [kept(output) for output in cell.outputs if output.get("name") != "stderr"]
        nbformat.write(notebook, path)
        sys.stdout.write(f"{path.name}\n")


def kept(output: dict) -> dict:
    """An output without the number of its run; of a picture only the picture."""
    if "execution_count" in output:
        output["execution_count"] = None
    data = output.get("data", {})
    if "image/png" in data:
        output["data"] = {"image/png": data["image/png"]}
    output.pop("metadata", None) if output["output_type"] == "stream" else output.update(metadata={})
    return output


if __name__ == "__main__":
    main()
