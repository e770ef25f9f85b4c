"""The examples, in packages that were built with them: `python -m wheelrail.examples FOLDER` copies them."""
