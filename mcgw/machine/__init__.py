"""What is asked of the machine: memory, compiled loops, threads, child processes, a terminal."""
