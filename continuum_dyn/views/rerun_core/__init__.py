"""Columns, times and layouts come in; what rerun's compiled core takes goes out."""
