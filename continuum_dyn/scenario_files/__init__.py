"""A TOML file and changes to it come in; a scenario goes out, or a message about the errors in the file."""
