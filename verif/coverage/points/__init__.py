"""Functional cover points, a module a block's folder: functions of the ports over all recorded cycles."""
