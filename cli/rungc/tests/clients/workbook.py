"""Reads a workbook of `rungc xref` with openpyxl: python workbook.py FILE. Prints what it holds as JSON."""

import json
import sys

import openpyxl

book = openpyxl.load_workbook(sys.argv[1])
sheet = book.active
rows = [list(row) for row in sheet.iter_rows(values_only=True)]
print(json.dumps([sheet.title, sheet.freeze_panes, sheet.auto_filter.ref, rows]))
