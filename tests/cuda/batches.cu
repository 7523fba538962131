#include "batches.cpp"
