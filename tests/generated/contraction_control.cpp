// What contraction.cpp must not become: under the same flags this does fuse, so the check of the assembly can fail.
double fused(double a, double b, double c) { return a * b + c; }
