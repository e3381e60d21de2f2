"""What a run leaves behind: its folder of files and its figures."""
