"""What applications write: figures, tables, and the folders that hold them."""
