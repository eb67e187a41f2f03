"""Results in words: tables, plans, the HTML report."""
