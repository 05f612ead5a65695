#!/usr/bin/env python3
"""Prints what is in a cohort: python3 read_cohort.py cohort.zip (GET /api/v1/export/cohort.zip)."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "clients/python"))  # or: pip install deploy/clients/python
from tractus_client import TractusError, read_cohort


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: read_cohort.py cohort.zip")
    with read_cohort(sys.argv[1]) as cohort:
        people = {trial["participant"] for trial in cohort.trials}
        print(f"trials {len(cohort.trials)} participants {len(people)} scores {len(cohort.scores)}")
        for trial in cohort.trials_with_samples():
            rows = cohort.samples(trial)
            print(f"samples {trial} rows {len(rows)} columns {len(rows[0])} last_t_s {rows[-1][0]:.6f}")


if __name__ == "__main__":
    try:
        main()
    except TractusError as error:
        sys.exit(f"read_cohort.py: {error}")
