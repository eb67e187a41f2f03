"""The measured error of the model: a table made of boundary-element solves, and its reader."""
