"""Client of a Tractus server for research: tables, samples, cohorts, analyses, trial files.

    from tractus_client import Server
    server = Server("https://tractus.example", token="tractus_...")
    trials = server.trials(study="S1")            # a list of dictionaries; trials.frame() with pandas
    for trial, samples in server.stream(study="S1", rate_Hz=100):
        ...
    server.cohort("cohort.zip", tier="full")
"""
from .cohort import read_cohort
from .errors import TractusError
from .server import Server
from .tables import Table
from .trial_file import read_trial

__all__ = ["Server", "Table", "TractusError", "read_cohort", "read_trial"]
