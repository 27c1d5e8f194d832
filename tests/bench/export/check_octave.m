% Calls liver.mex as users do, well and badly; in the folder that it was built in. Says what is not as it should be.
function check_octave()
  position = 0.4 + 0.1 * sin((0:499) / 30);
  velocity = 100 / 30 * 0.1 * cos((0:499) / 30);
  [all_at_once, last] = liver(position, velocity, 0.001);
  state = [];
  tick_by_tick = zeros(1, 500);
  for tick = 1:500
    [tick_by_tick(tick), state] = liver(position(tick), velocity(tick), 0.001, state);
  end
  demand(isequal(all_at_once, tick_by_tick), 'ticks one by one give other forces');
  demand(isequal(last, state) && isa(state, 'uint8'), 'and another state');
  demand(isequal(liver(position', velocity', 0.001 * ones(500, 1)), all_at_once'), 'columns give other forces');
  before = state;
  liver(position, velocity, 0.001, state);
  demand(isequal(before, state), 'a state was changed in its place');
  about = jsondecode(liver());
  demand(strcmp(about.model, 'kelvin') && about.parameters(1).value == 8, 'it does not say what it is');

  refused('liver(1, 2)', '2 arguments and 0 results; expected [force, state] = liver(');
  refused('[a, b, c] = liver(1, 2, 3)', '3 arguments and 3 results');
  refused('liver(single(1), 2, 0.001)', 'position is a single array; expected real numbers of class double');
  refused('liver(1i, 2, 0.001)', 'position is a complex double array');
  refused('liver(sparse(1), 2, 0.001)', 'position is a sparse double array');
  refused('liver(1, ''a'', 0.001)', 'velocity is a char array');
  refused('liver([], [], 0.001)', 'position is empty; expected a number for each tick');
  refused('liver(ones(2), ones(2), 0.001)', 'position is a matrix; expected a row or a column');
  refused('liver([1 2 3], [1 2], 0.001)', '3 positions, 2 velocities and 1 elapsed times; expected as many of each');
  refused('liver([1 2 3], [1 2 3], [1 2])', '3 positions, 3 velocities and 2 elapsed times');
  refused('liver([1 NaN], [1 2], 0.001)', 'position(2) is nan; expected a finite number');
  refused('liver([1 2], [1 Inf], 0.001)', 'velocity(2) is inf');
  refused('liver([1 2], [1 2], [0.001 0])', 'elapsed(2) is 0; expected seconds, more than zero');
  refused('liver(-1e308, 0, 0.001)', 'the force of tick 1, at position -1e+308 and velocity 0, is not finite');
  refused('liver(1, 2, 0.001, 5)', 'the state is 1 numbers of class double; expected what a call of liver gave');
  refused('liver(1, 2, 0.001, zeros(1, 32, "uint8"))', 'the state is of another law');
end

function demand(is, what)
  if (! is) error('%s', what); end
end

function refused(call, why)
  try
    eval([call ';']);
  catch failure
    demand(! isempty(strfind(failure.message, ['liver: ' why])), [call ' says: ' failure.message]);
    return
  end
  error('%s is not refused', call);
end
