"""The commands, one module each with a function `command`; a module here is a command of `flexapod`."""
