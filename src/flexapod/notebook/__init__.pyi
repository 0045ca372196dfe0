from .viewing import view as view
