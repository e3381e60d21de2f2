"""What a plug-in of each family promises."""
