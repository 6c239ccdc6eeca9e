"""Options, tables and messages of the commands: values come in, text for a terminal goes out."""
