"""The commands, one file each. They import what is heavy only when they are called."""
