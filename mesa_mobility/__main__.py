"""`python -m mesa_mobility` is the `mesa-mobility` command."""

from mesa_mobility._console_script import main

if __name__ == "__main__":
    main()
