"""The commands, one a file: a line of help, the arguments, and what is done."""
