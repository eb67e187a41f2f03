"""What is told in words: tables, plans, the HTML report."""
