"""A TOML file and changes to it come in; a scenario goes out, or words about what is wrong in the file."""
