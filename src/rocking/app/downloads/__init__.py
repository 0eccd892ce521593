"""What a user takes away: pictures, tables, a report, the animation, and the inputs as a file of the command line."""
