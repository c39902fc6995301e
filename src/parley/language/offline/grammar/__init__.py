"""A grammar beside the reader: from any wording to plain orders, in the order in which they are wanted."""
