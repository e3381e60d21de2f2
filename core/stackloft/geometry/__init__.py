"""Mathematics on plain arrays: no files, no logging, no model types."""
