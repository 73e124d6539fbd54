"""Who meets what, in which order, counted out for every slot."""
