#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scikit-learn under tribench: all products up to a degree, chosen by the lasso along its path.

Parameters: degree (3). Settings: ours (scikit-learn has no default for this task); LassoLarsIC with
BIC as it comes. Debian: python3-sklearn.
"""
import numpy as np

from protocol import answer, library, read_request, unsupported


def term(powers, names):
    parts = [name if p == 1 else f"{name}^{p}" for name, p in zip(names, powers) if p]
    return "*".join(parts)


def formula(offset, weights, powers, names):
    parts = [f"{float(w)!r}*{term(p, names)}" for w, p in zip(weights, powers) if w != 0]
    return " + ".join([repr(float(offset)), *parts])


def main():
    request, names, X, y = read_request()
    sklearn = library("sklearn", "apt install python3-sklearn")
    from sklearn.linear_model import LassoLarsIC, LinearRegression
    from sklearn.preprocessing import PolynomialFeatures, StandardScaler
    if not {"+", "*"} <= set(request["operators"]):
        unsupported("polynomials need + and *")
    degree = int(request["parameters"].get("degree", 3))
    X, y = np.array(X), np.array(y)
    products = PolynomialFeatures(degree, include_bias=False).fit(X)
    Z, powers = products.transform(X), products.powers_
    path = LassoLarsIC(criterion="bic", noise_variance=None if len(y) > Z.shape[1] + 1 else 1.0)
    chosen = path.fit(StandardScaler().fit_transform(Z), y).coef_ != 0
    front = [repr(float(y.mean()))]
    for keep in (np.sum(powers, axis=1) == 1, chosen):  # a plane, then what the lasso chose
        if keep.any():
            plain = LinearRegression().fit(Z[:, keep], y)
            front.append(formula(plain.intercept_, plain.coef_, powers[keep], names))
    answer(front, "ours", f"scikit-learn {sklearn.__version__}, degree {degree}")


if __name__ == "__main__":
    main()
