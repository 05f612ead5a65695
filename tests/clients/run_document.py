#!/usr/bin/env python3
"""Runs the code of a Jupyter notebook (Python) or an R Markdown, cell by cell in one process, with nothing but Python and R.

    run_document.py FILE.ipynb|FILE.Rmd CLIENTS     CLIENTS: the folder deploy/clients, whose clients need not be installed
"""
import json
import re
import subprocess
import sys
from pathlib import Path

path, clients = Path(sys.argv[1]), Path(sys.argv[2])
if path.suffix == ".ipynb":
    sys.path.insert(0, str(clients / "python"))
    names = {"__name__": "__main__"}
    for cell in json.loads(path.read_text())["cells"]:
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), f"{path.name}, {cell['id']}", "exec"), names)
else:
    chunks = re.findall(r"^```\{r[^}]*\}\n(.*?)^```", path.read_text(), re.MULTILINE | re.DOTALL)
    sources = f'for (file in list.files("{clients / "r/R"}", full.names = TRUE)) source(file)\n'
    program = sources + "\n".join(chunks).replace("library(tractus)\n", "")
    sys.exit(subprocess.run(["Rscript", "-"], input=program, text=True).returncode)
