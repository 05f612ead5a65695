"""Tables of a server: rows as dictionaries, numbers as numbers, None where there is no value."""
import csv
import io

_CONVERT = {"number": float, "integer": int, "truth": lambda text: text == "1"}
# Columns of GET /api/v1/cohort/table that are texts; the others are numbers.
COHORT_TEXTS = {"trial", "participant", "study", "cohort", "level", "date", "case", "rig"}


class Table(list):
    """A list of rows."""

    def __init__(self, rows, columns):
        super().__init__(rows)
        self.columns = columns

    def frame(self):
        """A pandas.DataFrame; needs pandas."""
        import pandas
        return pandas.DataFrame(list(self), columns=self.columns)

    def where(self, **wanted):
        """The rows whose columns have these values."""
        return Table([row for row in self if all(row[name] == value for name, value in wanted.items())], self.columns)


def kinds_in(dictionary_csv):
    """{(table, column): type} of a dictionary.csv."""
    return {(row["table"], row["column"]): row["type"] for row in csv.DictReader(io.StringIO(dictionary_csv))}


def parse_table(text, kind_of):
    """@param kind_of  maps a column's name to text, number, integer or truth"""
    reader = csv.DictReader(io.StringIO(text, newline=""))
    rows = []
    for row in reader:
        rows.append({column: None if cell == "" else _CONVERT.get(kind_of(column), str)(cell) for column, cell in row.items()})
    return Table(rows, reader.fieldnames or [])
