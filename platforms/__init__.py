"""The processes: only what lies here knows layers, models, paths into a PDK's wheel and its coefficients."""
