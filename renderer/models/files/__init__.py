"""Files of models as triangles with colours: glTF, OBJ, PLY and STL.

Readers of our own, because every general one at hand loses what participants would see: that
colours are linear, polygons concave, strips triangles, a texture missing (decisions/0011).
"""
