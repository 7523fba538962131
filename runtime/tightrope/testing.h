#pragma once
/// What generated tests are made of: exact reference values, inputs that make predicates err, checks. Host only,
/// standard library only; see docs/generated-code.md, "The generated tests".

#include <tightrope/testing/checks.h>
#include <tightrope/testing/exact_checks.h>
#include <tightrope/testing/inputs.h>
#include <tightrope/testing/properties.h>
#include <tightrope/testing/reference.h>
