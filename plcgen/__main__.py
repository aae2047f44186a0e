"""`python -m plcgen`."""

from plcgen.cli import main

if __name__ == "__main__":
    main(prog_name="plcgen")
