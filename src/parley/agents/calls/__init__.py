"""Calls people who do not look at any screen: robots that wait for them, by webhook or e-mail."""
