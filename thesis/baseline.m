% Time of one monolithic step as the thesis takes it: all displacements of wheel and rail, penalty contact without friction,
% backward Euler, Newton with one sparse factorisation in each iteration. Paper A's bodies and load at rest, on structured
% meshes of about its size. Prints seconds and Newton iterations per step; `make thesis` runs it where Octave is installed, with a file
% that holds the seconds of a step of the product, and then it prints the ratio, too.
1;

% Stiffness and mass of linear triangles in plane strain; unknowns 2i - 1 and 2i of node i.
function [K, M] = assemble(p, t, E, nu, rho)
  G = E / (2 * (1 + nu));
  L = E * nu / ((1 + nu) * (1 - 2 * nu));
  D = [L + 2 * G, L, 0; L, L + 2 * G, 0; 0, 0, G];
  I = zeros(36, rows(t)); J = I; V = I; W = I;
  for e = 1:rows(t)
    k = t(e, :); x = p(k, 1); y = p(k, 2);
    A2 = (x(2) - x(1)) * (y(3) - y(1)) - (x(3) - x(1)) * (y(2) - y(1));
    bx = [y(2) - y(3), y(3) - y(1), y(1) - y(2)] / A2;
    by = [x(3) - x(2), x(1) - x(3), x(2) - x(1)] / A2;
    B = zeros(3, 6);
    B(1, 1:2:6) = bx; B(2, 2:2:6) = by; B(3, 1:2:6) = by; B(3, 2:2:6) = bx;
    d = reshape([2 * k - 1; 2 * k], 1, 6);
    [c, r] = meshgrid(d, d);
    I(:, e) = r(:); J(:, e) = c(:);
    V(:, e) = reshape(A2 / 2 * (B' * D * B), 36, 1);
    W(:, e) = reshape(rho * A2 / 24 * kron(ones(3) + eye(3), eye(2)), 36, 1);
  end
  n = 2 * rows(p);
  K = sparse(I(:), J(:), V(:), n, n);
  M = sparse(I(:), J(:), W(:), n, n);
end

% Two triangles in each cell of a grid whose node (i, j) has the number i + (j - 1) m; `closed` joins the last i to the first.
% Counter-clockwise where i runs to the right of j.
function t = cells(m, n, closed)
  t = zeros(0, 3);
  for j = 1:n - 1
    for i = 1:m - ! closed
      a = i + (j - 1) * m; b = mod(i, m) + 1 + (j - 1) * m;
      t = [t; a, b, b + m; a, b + m, a + m];
    end
  end
end

E = 200e9; nu = 0.3; rho = 8000; ro = 0.46; ri = 0.046; load = 4.7e6; stiffness = 5e12; dt = 5e-5; steps = 20;

% Wheel: angles from the contact point on, dense there; radii from the tread inward.
s = linspace(-1, 1, 121)(1:120);
phi = pi * (0.1 * s + 0.9 * s .^ 3);
radius = ri + (ro - ri) * (1 - linspace(0, 1, 12) .^ 1.5);
[P, R] = ndgrid(phi, radius);
wheel = [R(:) .* sin(P(:)), ro - R(:) .* cos(P(:))];
tw = cells(120, 12, true);
% Rail: top first, then downward.
q = linspace(-1, 1, 61);
[X, Y] = ndgrid(0.5 * (0.15 * q + 0.85 * q .^ 3), -0.1 * linspace(0, 1, 7) .^ 1.5);
rail = [X(:), Y(:)];
tr = fliplr(cells(61, 7, false));
nw = rows(wheel);
p = [wheel; rail]; t = [tw; tr + nw];
% Every triangle counter-clockwise.
area = (p(t(:,2),1) - p(t(:,1),1)) .* (p(t(:,3),2) - p(t(:,1),2)) - (p(t(:,3),1) - p(t(:,1),1)) .* (p(t(:,2),2) - p(t(:,1),2));
t(area < 0, [2, 3]) = t(area < 0, [3, 2]);
[K, M] = assemble(p, t, E, nu, rho);

% Hub: held along, one unknown upward. Base of the rail: held.
hub = (nw - 119):nw; base = nw + (6 * 61 + 1):nw + 7 * 61;
held = [2 * hub - 1, 2 * base - 1, 2 * base];
free = setdiff(1:2 * rows(p), [held, 2 * hub]);
T = [sparse(free, 1:numel(free), 1, 2 * rows(p), numel(free)), sparse(2 * hub, ones(1, 120), 1, 2 * rows(p), 1)];
f = sparse(2 * rows(p), 1); f(2 * hub) = -load / 120;

% Tread nodes that may touch, with the segment of the rail below each: one row of G opens one gap.
near = find(abs(wheel(1:120, 1)) < 0.02 & wheel(1:120, 2) < 0.01);
G = sparse(numel(near), 2 * rows(p)); gap0 = zeros(numel(near), 1);
for k = 1:numel(near)
  i = near(k); x = wheel(i, 1);
  b = find(rail(1:61, 1) > x, 1); a = b - 1;
  share = (x - rail(a, 1)) / (rail(b, 1) - rail(a, 1));
  G(k, 2 * i) = 1; G(k, 2 * (nw + a)) = share - 1; G(k, 2 * (nw + b)) = -share;
  gap0(k) = wheel(i, 2);
end

u = zeros(2 * rows(p), 1); v = u; iterations = 0;
tic;
for step = 1:steps
  before = u;
  for k = 1:40
    gap = gap0 + G * u; touching = gap < 0;
    r = M * ((u - before) / dt - v) / dt + K * u - f + stiffness * (G' * (min(gap, 0)));
    if norm(T' * r) < 1e-8 * load, break; end
    A = M / dt ^ 2 + K + stiffness * (G(touching, :)' * G(touching, :));
    u -= T * ((T' * A * T) \ (T' * r));
    iterations += 1;
  end
  v = (u - before) / dt;
end
seconds = toc / steps;
printf("%d triangles, %.3g s and %.1f Newton iterations per step, contact force %.4g N/m\n", rows(t), seconds, iterations / steps, ...
       -stiffness * sum(min(gap0 + G * u, 0)));
if numel(argv()) > 0
  ours = dlmread(argv(){1});
  printf("%.0f times as long as a step of the product, %.3g s\n", seconds / ours(1), ours(1));
end
