"""The machine: memory, compiled loops, threads, child processes, terminal."""
