"""What a plug-in has to be: one suite for ours and for others', and the beginnings of new ones."""
