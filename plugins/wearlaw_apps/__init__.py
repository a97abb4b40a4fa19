"""What people do with models: tables, sweeps, fits, studies, lives, and a page to explore."""
