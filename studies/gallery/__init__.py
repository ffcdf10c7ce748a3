"""What the field runs, run here: docs/gallery.md, its numbers, pictures and films, from the option files of runs/gallery."""
