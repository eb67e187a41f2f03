"""What tests compare with, written independently of the product; and what they share."""
