// Opaque surfaces: the depth alone.
#version 460
void main() {}
