"""The task panel of a carved object: a box for each subject, each writing properties of the object."""
